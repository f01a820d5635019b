#include "runtime/export/formats/gltf_buffer.h"

#include <cmath>

namespace graftal {

int add_view(tinygltf::Model& model, std::span<const std::byte> bytes, int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = bytes.size();
    view.target = target;
    const auto* const first = reinterpret_cast<const unsigned char*>(bytes.data());
    data.insert(data.end(), first, first + bytes.size());
    return add_to(model.bufferViews, std::move(view));
}

int add_accessor(tinygltf::Model& model, int view, std::size_t count, int component, int type) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    return add_to(model.accessors, std::move(accessor));
}

int add_colours(tinygltf::Model& model, const std::vector<Rgb>& colours) {
    std::vector<std::uint16_t> channels;
    for (const Rgb& rgb : colours) {
        for (int i = 0; i < 3; ++i)
            channels.push_back(static_cast<std::uint16_t>(std::lround(65535 * rgb[i])));
        channels.push_back(65535);
    }
    const int view = add_view(model, std::as_bytes(std::span(channels)), TINYGLTF_TARGET_ARRAY_BUFFER);
    const int number =
        add_accessor(model, view, colours.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
    model.accessors.back().normalized = true;
    return number;
}

int add_corners(tinygltf::Model& model, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                std::size_t vertices) {
    const auto add = [&](std::span<const std::byte> bytes, int component) {
        const int view = add_view(model, bytes, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        return add_accessor(model, view, 3 * triangles.size(), component, TINYGLTF_TYPE_SCALAR);
    };
    if (vertices >= 65535)
        return add(std::as_bytes(std::span(triangles)), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    std::vector<std::uint16_t> small;
    for (const auto& corners : triangles)
        small.insert(small.end(), corners.begin(), corners.end());
    return add(std::as_bytes(std::span(small)), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

} // namespace graftal
