#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "compiler/support/stage_price.h"

namespace graftal {

/// Facts of the picture that prepare_graph() needs.
struct PrepareOptions {
    std::optional<unsigned> steps;            ///< levels; nothing: as deep as the error asks for
    bool culls = true;                        ///< whether anything is culled for its size
    bool keeps_objects = false;               ///< DetailOptions'
    std::uint64_t most_bodies = usual_bodies; ///< bodies drawn to fit proxies (fit_proxies())
    static constexpr std::uint64_t usual_bodies = 4'000'000;
    bool operator==(const PrepareOptions&) const = default;
};

struct DetailOptions {
    double error_px = 0.5; ///< parts whose diameter projects to at most this are culled; 0: nothing is
    std::optional<double> error_world;       ///< error_px as a length in scene units, in place of it
    std::optional<unsigned> steps;           ///< levels; nothing: as deep as the error asks for
    std::uint64_t memory_bytes = 2ull << 30; ///< POV-Ray's estimated peak
    /// Steps to which the light of culled parts is rounded. POV-Ray's scenes have finishes and meshes for
    /// each: by 64ths plants/autumn.inst had an error of 22 px within 1 GiB, by sixteenths of 4.
    int light_steps = 16;
    double work_seconds = 30;  ///< of one processor, for the picture (work.h); infinite: whatever it takes
    bool visible_only = false; ///< drop what is out of the picture, with its shadows and reflections
    /// Whether proxies show the limit's normals (mesh/limit_normal.h), or their own.
    bool limit_normals = true;
    bool keeps_objects = false; ///< of detail_passes(): what is met can be told by the model's objects

    /// Whether anything is culled for its size.
    bool culls() const { return error_world ? *error_world > 0 : error_px > 0; }
    PrepareOptions preparing() const {
        constexpr double share = 0.1; // of the work
        const double bodies = share * work_seconds / StagePrice::body;
        const auto usual = static_cast<double>(PrepareOptions::usual_bodies);
        return {steps, culls(), keeps_objects, static_cast<std::uint64_t>(std::min(bodies, usual))};
    }
    bool operator==(const DetailOptions&) const = default;
};

} // namespace graftal
