#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "runtime/trace/model/trace_model.h"

namespace graftal {

/// A model as Embree holds it: all leaves as triangles (curved ones as coarsely as can be), in one mesh; or
/// in meshes of some levels each, placed as instances. Requires a model of which nothing is culled.
class EmbreeScene {
  public:
    enum class Form { mesh, instances };
    EmbreeScene(const TraceModel& model, Form form);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// How many of the rays hit, from `least` on, one by one.
    std::size_t hits(std::span<const Ray> rays, double least, bool coherent) const;
    /// The same in packets of 8 and 16 neighbours of a picture that is `width` pixels wide: 4x2 and 4x4 of
    /// them. Requires that a packet divides the picture.
    std::size_t hits_by_8(std::span<const Ray> rays, std::size_t width) const;
    std::size_t hits_by_16(std::span<const Ray> rays, std::size_t width) const;

    std::size_t triangles() const { return triangles_; }
    double build_seconds() const { return build_seconds_; }
    double mib() const;

  private:
    struct Flat;
    struct Builder;
    RTCScene mesh_of(const Flat& flat) const;

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::vector<RTCScene> meshes_; ///< of instances
    std::vector<std::unique_ptr<Flat>> flats_;
    std::size_t triangles_ = 0; ///< were all in one mesh
    double build_seconds_ = 0;
    std::size_t embree_bytes_ = 0;
};

} // namespace graftal
