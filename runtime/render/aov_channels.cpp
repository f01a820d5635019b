#include "runtime/render/aov_channels.h"

#include <bit>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/trace/mattes.h"

namespace graftal {

namespace {

// Mattes in an EXR by the Cryptomatte specification 1.2.0 (Friedman and Jones): the layers CryptoObject,
// CryptoInstance and CryptoMaterial, each with three channels of two ids and their shares, whose bits are
// those of 32-bit floats. Each layer has a manifest, without which Blender takes none, but instances have no
// names: they may be millions.

struct Layer {
    std::string_view name;
    MatteShares PixelMattes::*shares;
};

constexpr Layer layers[] = {{"CryptoObject", &PixelMattes::objects},
                            {"CryptoInstance", &PixelMattes::instances},
                            {"CryptoMaterial", &PixelMattes::materials}};

constexpr std::size_t ids_a_channel = 2;

std::set<std::string_view> names_of(const Layer& layer, const DetailGraph& cut, const View& view) {
    std::set<std::string_view> names;
    if (layer.shares == &PixelMattes::materials) {
        for (const Material& material : cut.materials)
            names.insert(material_name(material));
        if (view.ground) names.insert(material_name(view.ground->material));
        names.insert(material_name({}));
        return names;
    }
    names.insert(object_name(cut, ground_node));
    if (layer.shares == &PixelMattes::objects)
        for (const DetailNode& node : cut.nodes)
            names.insert(node.name);
    return names;
}

std::string hex_of(std::uint32_t id) {
    return fmt::format("{:08x}", id);
}

/// Names of the channels of all layers, CryptoObject00.R to CryptoMaterial02.A.
std::vector<std::string> matte_channel_names() {
    std::vector<std::string> names;
    for (const Layer& layer : layers)
        for (std::size_t i = 0; i < MatteShares().size() / ids_a_channel; ++i)
            for (const char channel : {'R', 'G', 'B', 'A'})
                names.push_back(fmt::format("{}{:02}.{}", layer.name, i, channel));
    return names;
}

/// Appends a pixel's samples of these channels.
void append_mattes(const PixelMattes& mattes, std::vector<float>& samples) {
    for (const Layer& layer : layers)
        for (const MatteShare& share : mattes.*layer.shares)
            samples.insert(samples.end(), {std::bit_cast<float>(share.id), share.share});
}

/// The tags that name the layers and the ids that are seen, as "cryptomatte/..." and text. The names are
/// those of the graph and of the ground.
std::vector<std::pair<std::string, std::string>> matte_tags(const std::vector<PixelMattes>& picture,
                                                            const DetailGraph& cut, const View& view) {
    constexpr std::size_t key_digits = 7;
    std::vector<std::pair<std::string, std::string>> tags;
    for (const Layer& layer : layers) {
        std::set<std::uint32_t> seen;
        for (const PixelMattes& pixel : picture)
            for (const MatteShare& share : pixel.*layer.shares)
                if (share.id != 0) seen.insert(share.id);
        nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
        for (const std::string_view name : names_of(layer, cut, view))
            if (const std::uint32_t id = matte_id(name); seen.contains(id))
                manifest[std::string(name)] = hex_of(id);
        // A name that is no UTF-8 must not end the picture.
        const std::string text = manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        const std::string key = "cryptomatte/" + hex_of(matte_id(layer.name)).substr(0, key_digits) + "/";
        tags.insert(tags.end(), {{key + "name", std::string(layer.name)},
                                 {key + "hash", "MurmurHash3_32"},
                                 {key + "conversion", "uint32_to_float32"},
                                 {key + "manifest", text}});
    }
    return tags;
}

} // namespace

MoreChannels aov_channels(const AovPicture& aovs, const DetailGraph& cut, const View& view, bool alpha) {
    const ObjectNumbers numbers(cut);
    MoreChannels more;
    more.names = {"coverage", "Z",        "normal.X", "normal.Y", "normal.Z",
                  "albedo.R", "albedo.G", "albedo.B", "id",       "levels"};
    if (alpha) more.names.insert(more.names.begin(), "A");
    const std::vector<std::string> of_mattes = matte_channel_names();
    more.names.insert(more.names.end(), of_mattes.begin(), of_mattes.end());
    more.samples.reserve(aovs.pixels.size() * more.names.size());
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < aovs.pixels.size(); ++i) {
        const AovPixel& pixel = aovs.pixels[i];
        const std::uint32_t number = numbers.of(pixel.node);
        if (number > 0) seen.insert(number);
        if (alpha) more.samples.push_back(1);
        more.samples.insert(more.samples.end(), {pixel.coverage, pixel.depth});
        more.samples.insert(more.samples.end(), std::begin(pixel.normal), std::end(pixel.normal));
        more.samples.insert(more.samples.end(), std::begin(pixel.albedo), std::end(pixel.albedo));
        more.samples.insert(more.samples.end(),
                            {static_cast<float>(number), static_cast<float>(pixel.levels)});
        append_mattes(aovs.mattes[i], more.samples);
    }
    std::string names;
    for (const std::uint32_t number : seen)
        names += fmt::format("{} {}\n", number, numbers.names()[number - 1]);
    more.tags = matte_tags(aovs.mattes, cut, view);
    more.tags.insert(more.tags.begin(), {"graftal:ids", names});
    return more;
}

} // namespace graftal
