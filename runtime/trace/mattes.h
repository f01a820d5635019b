#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace graftal {

/// The id of a name: MurmurHash3_x86_32 with seed 0, kept from being the bits of a float that is not normal
/// (Friedman and Jones, "Cryptomatte" specification 1.2.0). 0 stands for nothing, and no name has it.
std::uint32_t matte_id(std::string_view name);

/// The id of a way from the root, as numbers of instances: of their bytes, the lowest first.
std::uint32_t matte_id(std::span<const std::uint32_t> way);

/// Ids of what a sample meets; 0: nothing.
struct MatteIds {
    std::uint32_t object = 0;   ///< the canonical object that holds the primitive
    std::uint32_t instance = 0; ///< the way to that object
    std::uint32_t material = 0; ///< its material
};

/// The share of a pixel that belongs to one id.
struct MatteShare {
    std::uint32_t id = 0;
    float share = 0;
};

/// The largest shares of a pixel, in falling order, equal ones by their ids; the rest are 0. What does not
/// fit in is left out.
using MatteShares = std::array<MatteShare, 6>;

/// Shares of a pixel, of its objects, of their instances and of its materials.
struct PixelMattes {
    MatteShares objects{}, instances{}, materials{};
};

/// The samples of a pixel by their ids.
class MatteSum {
  public:
    void add(const MatteIds& ids, double weight);
    /// `whole`: the weight of all samples, those that meet nothing included; positive.
    PixelMattes shares(double whole) const;

  private:
    struct Part {
        std::uint32_t id = 0;
        double weight = 0;
    };
    using Parts = std::vector<Part>;

    static void add(Parts& parts, std::uint32_t id, double weight);
    static MatteShares largest(Parts parts, double whole);

    Parts objects_, instances_, materials_;
};

} // namespace graftal
