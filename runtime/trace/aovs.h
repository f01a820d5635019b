#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/scene/scene.h"
#include "compiler/support/ray.h"
#include "runtime/trace/mattes.h"
#include "runtime/trace/shade/surfaces.h"

namespace graftal {

/// Values of a pixel besides its light ("arbitrary output variables"). Means are over the samples that meet
/// a surface, by their weights in the pixel. Other values are of the sample nearest to the middle.
struct AovPixel {
    float coverage = 0;                                   ///< share of the samples that meet a surface
    float depth = std::numeric_limits<float>::infinity(); ///< along the camera's direction, mean
    float normal[3] = {}, albedo[3] = {};                 ///< means; 0 where nothing is met
    std::uint32_t node = SurfaceHit::no_node;             ///< SurfaceHit::node; of the ground ground_node
    std::uint32_t levels = 0;
};

/// In place of a node of the model.
inline constexpr std::uint32_t ground_node = SurfaceHit::no_node - 1;

/// Row by row, top first.
struct AovPicture {
    std::vector<AovPixel> pixels;
    std::vector<PixelMattes> mattes; ///< of each pixel; empty where nobody asks for them

    AovPicture() = default;
    explicit AovPicture(std::size_t size, bool with_mattes = false)
        : pixels(size), mattes(with_mattes ? size : 0) {}
};

/// The first surface that one sample meets.
struct AovSample {
    bool met = false;
    double depth = 0;
    Vec3 normal{0.0}; ///< of unit length, towards the viewer
    Rgb albedo{0.0};
    std::uint32_t node = SurfaceHit::no_node;
    std::uint32_t levels = 0;
    MatteIds mattes; ///< where they are asked for

    AovSample() = default;
    /// `hit` is of the ray, and has no material where nothing is met. What is no number is not met. `named`:
    /// null, or the graph whose names make the mattes.
    AovSample(const SurfaceHit& hit, const Ray& ray, const View& view, const DetailGraph* named = nullptr);
};

/// The samples of a pixel.
class AovSum {
  public:
    /// `off_middle`: any measure of the distance from the pixel's middle. Of equal ones the first counts.
    void add(const AovSample& sample, double weight, double off_middle);
    AovPixel pixel() const;
    PixelMattes mattes() const { return weight_ > 0 ? mattes_.shares(weight_) : PixelMattes{}; }

  private:
    double weight_ = 0, met_weight_ = 0;
    double depth_ = 0;
    Vec3 normal_{0.0};
    Rgb albedo_{0.0};
    double nearest_ = std::numeric_limits<double>::infinity();
    std::uint32_t node_ = SurfaceHit::no_node;
    std::uint32_t levels_ = 0;
    MatteSum mattes_;
};

/// Names of what mattes tell apart: of a node of the graph or of ground_node, and of a material.
std::string_view object_name(const DetailGraph& cut, std::uint32_t node);
std::string_view material_name(const Material& material);

/// Numbers for the objects of a model, from 1 on in the order of its graph; 0 is nothing. Nodes that stand
/// for one object, such as its halves, share its number. The last number is the ground's.
class ObjectNumbers {
  public:
    explicit ObjectNumbers(const DetailGraph& cut);

    std::uint32_t of(std::uint32_t node) const;
    /// Names by number, from 1 on.
    const std::vector<std::string>& names() const { return names_; }

  private:
    std::vector<std::uint32_t> number_of_node_;
    std::vector<std::string> names_;
};

} // namespace graftal
