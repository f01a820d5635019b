// Hart 1992, eq. (9) and (10): however a path is divided between the placement of a mesh and the mesh, the
// tints along it give one colour, that of the whole path, in linear light to the last bit of 16. The colour
// is computed here from the path alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/image/drawing.h"
#include "tests/image/parted_cut.h"

namespace graftal {
namespace {

/// A contraction onto one cell of a grid, by 1 / `cells`, with a mirror or two.
struct Letter {
    std::array<double, 3> sign{1, 1, 1};
    std::array<double, 3> centre{};
    std::array<double, 3> rgb{};
    double alpha = 0;
};

/// Cells of [-1, 1]^3 or of a plate in it, seen from the front, letters upon letters.
struct GridModel {
    int cells = 2;
    std::vector<Letter> letters;
    std::vector<std::vector<bool>> follows; ///< follows[i][j]: i may stand below j
    std::array<double, 3> base{};           ///< the colour of the terminal
    std::array<double, 3> half{1, 1, 1};    ///< of the terminal
    unsigned steps = 3;
};

struct Leaf {
    std::array<double, 3> centre{};
    std::array<double, 3> half{};
    std::array<double, 3> rgb{};
};

/// All leaves, by writing down every word; `colour` and `through` are what the word so far shows and leaves.
class Words {
  public:
    explicit Words(const GridModel& model) : model_(model) { extend({}, model.half, {}, 1, {1, 1, 1}, 0, 0); }

    std::vector<Leaf> leaves;

  private:
    void extend(std::array<double, 3> centre, std::array<double, 3> half, std::array<double, 3> colour,
                double through, std::array<double, 3> sign, std::size_t last, unsigned length) {
        if (length == model_.steps) {
            for (std::size_t k = 0; k < 3; ++k)
                colour[k] += through * model_.base[k];
            leaves.push_back({centre, half, colour});
            return;
        }
        const double size = std::pow(model_.cells, -static_cast<double>(length));
        for (std::size_t i = 0; i < model_.letters.size(); ++i) {
            if (length > 0 && !model_.follows[i][last]) continue;
            const Letter& letter = model_.letters[i];
            std::array<double, 3> c = centre, h = half, seen = colour, s = sign;
            for (std::size_t k = 0; k < 3; ++k) {
                c[k] += size * sign[k] * letter.centre[k];
                h[k] /= model_.cells;
                s[k] *= letter.sign[k];
                seen[k] += through * letter.alpha * letter.rgb[k];
            }
            extend(c, h, seen, through * (1 - letter.alpha), s, i, length + 1);
        }
    }

    const GridModel& model_;
};

std::string text_of(const GridModel& model) {
    // The camera is a little beside the middle: no ray runs along the edge of a cell.
    std::string text =
        "camera { orthographic location: 0.0013, 0.0007, 5 look_at: 0.0013, 0.0007, 0 width: 2.2 }\n"
        "background: 0, 0, 0\n";
    text += fmt::format("material plain {{ color: {}, {}, {} ambient: 1 diffuse: 0 specular: 0 }}\n",
                        model.base[0], model.base[1], model.base[2]);
    text += "rifs grid {\n";
    for (std::size_t i = 0; i < model.letters.size(); ++i) {
        const Letter& l = model.letters[i];
        text += fmt::format(
            "  map w{} {{ scale {}/{}, {}/{}, {}/{} translate {}, {}, {} tint {}, {}, {}, {} }}\n", i,
            l.sign[0], model.cells, l.sign[1], model.cells, l.sign[2], model.cells, l.centre[0], l.centre[1],
            l.centre[2], l.rgb[0], l.rgb[1], l.rgb[2], l.alpha);
    }
    for (std::size_t i = 0; i < model.letters.size(); ++i)
        for (std::size_t j = 0; j < model.letters.size(); ++j)
            if (model.follows[i][j]) text += fmt::format("  follow w{} -> w{}\n", i, j);
    return text + fmt::format("  terminal cube scale {}, {}, {} material plain\n}}\n", model.half[0],
                              model.half[1], model.half[2]);
}

constexpr int size_px = 120;

/// The colours of what each pixel meets first.
Image expected_picture(const GridModel& model) {
    const Words words(model);
    Image image{size_px, size_px, 3, {}};
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            const double unit = 2.2 / size_px;
            const double at[2] = {(x + 0.5 - size_px / 2) * unit + 0.0013,
                                  (size_px / 2 - y - 0.5) * unit + 0.0007};
            double front = -std::numeric_limits<double>::infinity();
            std::array<double, 3> colour{};
            for (const Leaf& leaf : words.leaves) {
                if (std::abs(at[0] - leaf.centre[0]) > leaf.half[0] ||
                    std::abs(at[1] - leaf.centre[1]) > leaf.half[1] || leaf.centre[2] + leaf.half[2] <= front)
                    continue;
                front = leaf.centre[2] + leaf.half[2];
                colour = leaf.rgb;
            }
            image.pixels.insert(image.pixels.end(), colour.begin(), colour.end());
        }
    return image;
}

/// One unit of 65535, and what a float loses.
constexpr double last_bit = 1.001 / 65535;

/// Draws the model parted at several levels, and as the absolute specification.
void expect_the_law(const GridModel& model, std::size_t least_ways) {
    const std::string text = text_of(model);
    SCOPED_TRACE(text);
    const std::optional<CompiledModel> whole_model =
        compile_text("grid.rifs", text, whole({size_px, size_px}, model.steps));
    ASSERT_TRUE(whole_model);
    const Image expected = expected_picture(model);
    std::vector<Image> pictures;
    std::vector<std::uint64_t> placements;
    double from_expected = 0, from_each_other = 0;
    for (const double threshold : {0.0, 12.0 * 9, 12.0 * 65, 12.0 * 400, 1e9}) {
        const CompiledModel parted = parted_at(*whole_model, threshold);
        if (!placements.empty() && parted.cut.placement_count == placements.back()) continue;
        placements.push_back(parted.cut.placement_count);
        pictures.push_back(draw(parted, SampleFormat::linear16));
        ASSERT_EQ(pictures.back().width, size_px);
        const ImageDifference difference = compare_images(pictures.back(), expected, last_bit);
        EXPECT_EQ(difference.over_threshold, 0u)
            << "parted into " << placements.back() << ": " << difference.max * 65535 << "/65535";
        from_expected = std::max(from_expected, difference.max);
        for (const Image& other : pictures)
            from_each_other = std::max(from_each_other, compare_images(pictures.back(), other).max);
    }
    EXPECT_LE(from_each_other, last_bit);
    EXPECT_GE(placements.size(), least_ways) << "the path was not divided at enough places";
    testing::Test::RecordProperty("ways_of_parting", static_cast<int>(placements.size()));
    testing::Test::RecordProperty("from_closed_form_in_65535ths", std::to_string(from_expected * 65535));
    testing::Test::RecordProperty("from_each_other_in_65535ths", std::to_string(from_each_other * 65535));
}

std::vector<std::vector<bool>> all_except_self(std::size_t count) {
    std::vector<std::vector<bool>> follows(count, std::vector<bool>(count, true));
    for (std::size_t i = 0; i < count; ++i)
        follows[i][i] = false;
    return follows;
}

// The eight colours of section 5 of the paper, each of alpha one half.
TEST(TintLaw, PoundSign) {
    GridModel model{.follows = all_except_self(8), .base = {0.8, 0.8, 0.8}, .steps = 4};
    for (int i = 0; i < 8; ++i) {
        const double right = i & 1, upper = i >> 1 & 1, front = i >> 2 & 1;
        model.letters.push_back(
            {.centre = {right - 0.5, upper - 0.5, front - 0.5}, .rgb = {front, right, upper}, .alpha = 0.5});
    }
    expect_the_law(model, 4);
}

TEST(TintLaw, RandomGridsOfThePlane) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        std::mt19937_64 random(seed);
        const auto share = [&](unsigned parts) {
            return static_cast<double>(random() % (parts + 1)) / parts;
        };
        const int cells = 2 + static_cast<int>(random() % 2);
        GridModel model{.cells = cells,
                        .base = {share(1000), share(1000), share(1000)},
                        .half = {1, 1, 0.05},
                        .steps = cells == 2 ? 5u : 4u};
        for (int row = 0; row < cells; ++row)
            for (int column = 0; column < cells; ++column) {
                Letter letter{.centre = {(2 * column + 1.0) / cells - 1, (2 * row + 1.0) / cells - 1, 0},
                              .rgb = {share(1000), share(1000), share(1000)},
                              .alpha = share(100)};
                if (random() % 6 == 0) letter.alpha = static_cast<double>(random() % 2);
                for (std::size_t k = 0; k < 2; ++k)
                    letter.sign[k] = random() % 3 == 0 ? -1 : 1;
                model.letters.push_back(letter);
            }
        const std::size_t count = model.letters.size();
        model.follows.assign(count, std::vector<bool>(count));
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                model.follows[i][j] = j == (i + 1) % count || random() % 3 != 0;
        expect_the_law(model, 3);
    }
}

} // namespace
} // namespace graftal
