#include "runtime/export/formats/picture_copies.h"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/system/temporary_directory.h"

namespace graftal {

std::string PictureCopies::name(MaterialId id) {
    const std::string& picture = job_.scene.materials[id].texture;
    const auto [known, is_new] = names_.try_emplace(picture);
    if (!is_new) return known->second;
    const std::filesystem::path output = job_.options.output;
    const std::string name = fmt::format("{}_{}.png", output.stem().string(), names_.size());
    known->second = name;
    Status status;
    const std::shared_ptr<const Texture> texture = job_.textures.load(picture, status);
    if (texture) {
        pending_.push_back(std::make_unique<PendingFile>((output.parent_path() / name).string()));
        status = pending_.back()->status();
        if (status.ok()) status = write_texture(*pending_.back(), *texture);
    }
    if (status_.ok()) status_ = status;
    return name;
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
