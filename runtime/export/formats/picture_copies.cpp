#include "runtime/export/formats/picture_copies.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "runtime/image_files/image_files.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

std::string PictureCopies::name(MaterialId id) {
    const std::string& picture = job_.scene.materials[id].texture;
    const auto [known, is_new] = names_.try_emplace(picture);
    if (!is_new) return known->second;
    const std::string name = known->second = unused(stem(job_.scene.materials[id]), ".png");
    Status status;
    const std::shared_ptr<const Texture> texture = job_.textures.load(picture, status);
    if (texture) {
        PendingFile& file = begin(name);
        status = file.status();
        if (status.ok()) status = write_texture(file, *texture);
    }
    if (status_.ok()) status_ = status;
    return name;
}

std::string PictureCopies::sky(const SkyPicture& picture) {
    std::string name = unused("sky", ".exr");
    Image image{picture.width(), picture.height(), 3, {}};
    for (const SkyPicture::Texel& texel : picture.texels())
        image.pixels.insert(image.pixels.end(), texel.begin(), texel.end());
    PendingFile& file = begin(name);
    Status status = file.status();
    if (status.ok()) status = write_image(file, image, SampleFormat::linear16);
    if (status_.ok()) status_ = status;
    return name;
}

std::string PictureCopies::stem(const Material& material) {
    std::string stem = std::filesystem::path(material.texture).stem().string().substr(0, 64);
    for (char& c : stem)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    return stem;
}

/// The name of a picture begins with that of the file, and is that of no picture of the model: none of these
/// is lost to a copy.
std::string PictureCopies::unused(const std::string& stem, std::string_view ending) {
    const std::string first =
        fmt::format("{}_{}", std::filesystem::path(job_.options.output).stem().string(), stem);
    std::string name = first;
    for (int number = 2; is_of_model(name + std::string(ending)) || !used_.insert(name).second; ++number)
        name = fmt::format("{}_{}", first, number);
    return name.append(ending);
}

/// Whether a file of this name beside the output is a picture that the model names.
bool PictureCopies::is_of_model(const std::string& name) const {
    const std::filesystem::path path = std::filesystem::path(job_.options.output).parent_path() / name;
    return std::ranges::any_of(job_.scene.materials, [&](const Material& material) {
        std::error_code error;
        return !material.texture.empty() && std::filesystem::equivalent(path, material.texture, error);
    });
}

PendingFile& PictureCopies::begin(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(job_.options.output).parent_path();
    return *pending_.emplace_back(std::make_unique<PendingFile>((folder / name).string()));
}

std::vector<unsigned char> PictureCopies::png(MaterialId id) {
    const auto make = [&](std::string& bytes) -> Status {
        Status status;
        const std::shared_ptr<const Texture> texture =
            job_.textures.load(job_.scene.materials[id].texture, status);
        if (!texture) return status;
        TemporaryDirectory folder;
        status = folder.create();
        if (!status.ok()) return status;
        PendingFile file(folder.path() + "/picture.png");
        status = file.status();
        if (status.ok()) status = write_texture(file, *texture);
        return status.ok() ? read_text(file.temporary_path(), bytes) : status;
    };
    std::string bytes;
    const Status status = make(bytes);
    if (status_.ok()) status_ = status;
    return {bytes.begin(), bytes.end()};
}

Status PictureCopies::commit(std::initializer_list<PendingFile*> files) {
    if (!status_.ok()) return status_;
    std::vector<PendingFile*> all;
    for (const std::unique_ptr<PendingFile>& picture : pending_)
        all.push_back(picture.get());
    all.insert(all.end(), files.begin(), files.end());
    return commit_together(all);
}

} // namespace graftal
