#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

using Places = std::vector<std::array<double, 2>>;

/// A symmetry of Context Free, and the places to which it sends a point beside itself.
struct SymmetryCase {
    std::string symmetry;
    std::function<Places(double x, double y)> others;
};

std::string grammar_of(const std::string& tile, const std::string& symmetry, double x = 0.1, double y = 0.2) {
    return fmt::format("startshape A\n{}CF::Symmetry = {}\nshape A {{ SQUARE [x ({}) y ({})] }}",
                       tile.empty() ? "" : "CF::Tile = [" + tile + "]\n", symmetry, x, y);
}

/// Checks that the shapes are one in each tile for the point and each other place. The tile repeats by (w, 0)
/// and (lean, h); 0 where it does not.
void expect_places(const std::string& tile, double w, double lean, double h,
                   const std::vector<SymmetryCase>& cases) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.9, 0.9);
    const std::size_t tiles = (w > 0 ? 5 : 1) * (h > 0 ? 5 : 1);
    for (const SymmetryCase& row : cases) {
        const double x = place(random), y = place(random);
        const ImportedShapes model("a.cfdg", grammar_of(tile, row.symmetry, x, y));
        Places places = row.others(x, y);
        places.push_back({x, y});
        std::vector<std::size_t> found(places.size());
        const std::vector<UnfoldedLeaf> leaves = model.leaves();
        EXPECT_EQ(leaves.size(), places.size() * tiles) << row.symmetry << model.said();
        for (const UnfoldedLeaf& leaf : leaves)
            for (std::size_t i = 0; i < places.size(); ++i) {
                double right = leaf.world_from_object.translation.x - places[i][0],
                       up = leaf.world_from_object.translation.y - places[i][1];
                const double rows = h > 0 ? std::round(up / h) : 0;
                right -= rows * lean;
                const double columns = w > 0 ? std::round(right / w) : 0;
                if (std::hypot(right - columns * w, up - rows * h) < 1e-6) ++found[i];
            }
        for (const std::size_t count : found)
            EXPECT_EQ(count, tiles) << row.symmetry << " of " << x << ", " << y;
    }
}

TEST(ContextFreeSymmetry, OfWallpapers) {
    expect_places("s 2", 2, 0, 2,
                  {{"CF::pm, 0.2, 0.4",
                    [](double x, double y) {
                        return Places{{x, 0.8 - y}};
                    }},
                   {"CF::pm, 1.9, 0.4",
                    [](double x, double y) {
                        return Places{{0.8 - x, y}};
                    }},
                   {"CF::pg, 0, 0.4",
                    [](double x, double y) {
                        return Places{{x + 1, 0.8 - y}};
                    }},
                   {"CF::pg, 1",
                    [](double x, double y) {
                        return Places{{-x, y + 1}};
                    }},
                   {"CF::cm, 2, sqrt(0.5)",
                    [](double x, double y) {
                        return Places{{y - 1, x + 1}};
                    }},
                   {"CF::pmm, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, y}, {x, 0.6 - y}, {0.2 - x, 0.6 - y}};
                    }},
                   {"CF::cmm, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, y}, {x, 0.6 - y}, {0.2 - x, 0.6 - y}};
                    }},
                   {"CF::pmg, 0, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{x, 0.6 - y}, {0.2 - x, y + 1}, {0.2 - x, 1.6 - y}};
                    }},
                   {"CF::pmg, 1, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, y}, {x + 1, 0.6 - y}, {1.2 - x, 0.6 - y}};
                    }},
                   {"CF::pgg, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, y + 1}, {x + 1, 0.6 - y}, {1.2 - x, 1.6 - y}};
                    }},
                   {"CF::p4, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.4 - y, x + 0.2}, {0.2 - x, 0.6 - y}, {y - 0.2, 0.4 - x}};
                    }},
                   {"CF::p4m",
                    [](double x, double y) {
                        return Places{{-y, x}, {-x, -y}, {y, -x}, {y, x}, {-x, y}, {-y, -x}, {x, -y}};
                    }},
                   {"CF::p4g", [](double x, double y) {
                        return Places{{-y, x},          {-x, -y},        {y, -x},       {-x - 1, y + 1},
                                      {-y - 1, -x - 1}, {x + 1, -y - 1}, {y + 1, x + 1}};
                    }}});
}

/// A square tile that stands on its corner.
TEST(ContextFreeSymmetry, OfWallpapersOnATileThatStandsOnItsCorner) {
    expect_places("s 2 1 skew (atan(0.5)) 0", 2, 1, 1,
                  {{"CF::pm, 2, sqrt(0.5)",
                    [](double x, double y) {
                        return Places{{y + 1, x - 1}};
                    }},
                   {"CF::pm, 3.5, sqrt(0.02)",
                    [](double x, double y) {
                        return Places{{0.2 - y, 0.2 - x}};
                    }},
                   {"CF::pg, 3",
                    [](double x, double y) {
                        return Places{{0.5 - y, -0.5 - x}};
                    }},
                   {"CF::cm, 0, 0.1",
                    [](double x, double y) {
                        return Places{{x, 0.2 - y}};
                    }},
                   {"CF::cm, 1, 0.1", [](double x, double y) {
                        return Places{{0.2 - x, y}};
                    }}});
}

TEST(ContextFreeSymmetry, OfFriezes) {
    expect_places("s 2 0", 2, 0, 0,
                  {{"CF::p11g, 0.3",
                    [](double x, double y) {
                        return Places{{x + 1, 0.6 - y}};
                    }},
                   {"CF::p11m, 0.3",
                    [](double x, double y) {
                        return Places{{x, 0.6 - y}};
                    }},
                   {"CF::p1m1, 0.3",
                    [](double x, double y) {
                        return Places{{0.6 - x, y}};
                    }},
                   {"CF::p2, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, 0.6 - y}};
                    }},
                   {"CF::p2mg, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, 0.6 - y}, {x + 1, 0.6 - y}, {1.2 - x, y}};
                    }},
                   {"CF::p2mm, 0.1, 0.3", [](double x, double y) {
                        return Places{{0.2 - x, y}, {x, 0.6 - y}, {0.2 - x, 0.6 - y}};
                    }}});
    expect_places("s 0 2", 0, 0, 2,
                  {{"CF::p11g, 0.3",
                    [](double x, double y) {
                        return Places{{0.6 - x, y + 1}};
                    }},
                   {"CF::p1m1, 0.3",
                    [](double x, double y) {
                        return Places{{x, 0.6 - y}};
                    }},
                   {"CF::p2mg, 0.1, 0.3", [](double x, double y) {
                        return Places{{0.2 - x, 0.6 - y}, {0.2 - x, y + 1}, {x, 1.6 - y}};
                    }}});
}

TEST(ContextFreeSymmetry, WithoutATile) {
    const double c = std::cos(std::acos(-1.0) * 0.8), s = std::sin(std::acos(-1.0) * 0.8);
    expect_places("", 0, 0, 0,
                  {{"CF::Cyclic, 2.5",
                    [&](double x, double y) {
                        return Places{{c * x - s * y, s * x + c * y}};
                    }},
                   {"CF::Cyclic, 2, 0.1, 0.3",
                    [](double x, double y) {
                        return Places{{0.2 - x, 0.6 - y}};
                    }},
                   {"CF::Dihedral, 1, 90",
                    [](double x, double y) {
                        return Places{{-x, y}};
                    }},
                   {"CF::Dihedral, 1, 45, 0.1, 0.3", [](double x, double y) {
                        return Places{{y - 0.2, x + 0.2}};
                    }}});
}

TEST(ContextFreeSymmetry, RefusesNumbersAndTilesThatDoNotFit) {
    const auto said = [](const std::string& tile, const std::string& symmetry) {
        const ImportedShapes model("a.cfdg", grammar_of(tile, symmetry));
        EXPECT_FALSE(model.graph) << symmetry;
        EXPECT_EQ(model.said().find("error:"), model.said().rfind("error:")) << "one error: " << model.said();
        return model.said();
    };
    EXPECT_THAT(said("s 2", "CF::pm, 2"), HasSubstr("a.cfdg:3:1: error: 'CF::pm' takes an axis of 0 or 1"));
    EXPECT_THAT(said("s 2", "CF::pm, -1"), HasSubstr("takes an axis of 0 or 1"));
    EXPECT_THAT(said("s 2", "CF::cm, 0"), HasSubstr("takes an axis of 2 or 3"));
    EXPECT_THAT(said("s 2", "CF::pg, 0, 1, 2"), HasSubstr("takes an axis, and may take an offset"));
    EXPECT_THAT(said("s 2", "CF::pmg, 0, 1"),
                HasSubstr("takes an axis, and may take the two numbers of a centre"));
    EXPECT_THAT(said("s 2", "CF::cmm, 0.2"), HasSubstr("takes no number, or the two of a centre"));
    EXPECT_THAT(said("s 2 0", "CF::p2mg, 1"), HasSubstr("takes no number, or the two of a centre"));
    EXPECT_THAT(said("s 2 0", "CF::p11m, 1, 2"), HasSubstr("takes no number, or the offset of its axis"));
    EXPECT_THAT(said("s 2", "CF::p11m"), HasSubstr("needs a 'CF::Tile' of one direction"));
    EXPECT_THAT(said("", "CF::p4m"), HasSubstr("needs a 'CF::Tile' of two directions"));
    EXPECT_THAT(said("s 2", "CF::p6m"), HasSubstr("does not fit this 'CF::Tile'"));
    EXPECT_THAT(said("", "CF::Cyclic, 3, 1"), HasSubstr("takes an order of 1 to 1000"));
    EXPECT_THAT(said("", "CF::Cyclic"), HasSubstr("takes an order of 1 to 1000"));
}

} // namespace
} // namespace graftal::testing
