#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "compiler/detail/prepare.h"
#include "compiler/scene/scene.h"
#include "compiler/unfolded/flat.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

namespace kernel_layout {
using glm::uvec4;
using glm::vec4;
#include "runtime/gpu/kernel/layout.glsl"
} // namespace kernel_layout

/// A model, its view and its light as the kernel reads them (kernel/layout.glsl): arrays without pointers, in
/// single precision, each part in its own frame. World space has its origin at the camera.
struct FlatModel {
    std::vector<glm::vec4> boxes, parts, lows, nodes, looks, materials, triangles;
    std::vector<float> texels;
    std::vector<std::uint32_t> source; ///< by node: that of the prepared graph
    /// The kernel that a model gets knows only what the model has.
    struct Features {
        bool stretched = false;   ///< some map of an object scales unevenly
        bool even = true;         ///< none turns, mirrors or stretches
        bool patterned = false;   ///< some material has a solid pattern
        bool pictured = false;    ///< some material has a picture
        bool glassy = false;      ///< some material lets light through
        bool translucent = false; ///< some material scatters light to its other side
        bool paired = false;     ///< the view shows parts of the root that are too small for single precision
        bool crushed = false;    ///< some part is flat, or may become so in a cycle
        std::uint32_t kinds = 0; ///< of primitives that rays meet as they are: a bit each
    } features;
    kernel_layout::Scene scene{};

    std::uint64_t bytes() const;
};

/// A picture that the kernel is to draw.
struct FlatRequest {
    const PreparedGraph& prepared;
    const View& view;
    const DetailOptions& detail;
    const ModelTextures& textures;
    const ShaderLimits& limits;
    const Sampling& sampling;
};

/// Nothing where the kernel cannot draw the model; `why` then names the first thing that it lacks: "a picture
/// on a surface". O(model).
std::optional<FlatModel> flat_model(const FlatRequest& request, std::string& why);

} // namespace graftal
