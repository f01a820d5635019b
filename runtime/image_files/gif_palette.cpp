#include "runtime/image_files/gif_palette.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace graftal {

namespace {

constexpr unsigned bin_bits = 5, choice_bits = 7;

std::size_t number_of_cell(const Levels& colour, unsigned bits) {
    std::size_t number = 0;
    for (const std::uint8_t level : colour)
        number = number << bits | level >> (8 - bits);
    return number;
}

int squared_distance(const std::array<int, 3>& a, const Levels& b) {
    int sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
        sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/// Bayer's matrix of side 8 (1973): numbers 0 to 63, neighbours far apart.
int threshold(std::size_t x, std::size_t y) {
    std::size_t number = 0;
    for (int bit = 0; bit < 3; ++bit) {
        const std::size_t across = x >> bit & 1, down = y >> bit & 1;
        number = number << 2 | (across ^ down) << 1 | down;
    }
    return static_cast<int>(number);
}

} // namespace

void GifPalette::Bin::add(const Bin& other) {
    count += other.count;
    for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += other.sum[c];
        squares[c] += other.squares[c];
    }
}

double GifPalette::Bin::mean(std::size_t channel) const {
    return static_cast<double>(sum[channel]) / static_cast<double>(count);
}

double GifPalette::Bin::variance(std::size_t channel) const {
    return static_cast<double>(squares[channel]) - mean(channel) * static_cast<double>(sum[channel]);
}

double GifPalette::Bin::error() const {
    return variance(0) + variance(1) + variance(2);
}

void GifPalette::count(std::span<const Levels> pixels) {
    bins_.resize(std::size_t{1} << 3 * bin_bits);
    for (const Levels& colour : pixels) {
        Bin& bin = bins_[number_of_cell(colour, bin_bits)];
        ++bin.count;
        for (std::size_t c = 0; c < 3; ++c) {
            bin.sum[c] += colour[c];
            bin.squares[c] += static_cast<std::uint64_t>(colour[c]) * colour[c];
        }
    }
}

std::vector<GifPalette::Box> GifPalette::halves_of(const Box& box) const {
    std::size_t axis = 0;
    for (std::size_t c = 1; c < 3; ++c)
        if (box.all.variance(c) > box.all.variance(axis)) axis = c;
    std::vector<Box> halves(2);
    for (const std::uint32_t bin : box.bins) {
        Box& half = halves[bins_[bin].mean(axis) > box.all.mean(axis) ? 1 : 0];
        half.bins.push_back(bin);
        half.all.add(bins_[bin]);
    }
    return halves;
}

void GifPalette::make() {
    Box whole;
    for (std::uint32_t i = 0; i < bins_.size(); ++i)
        if (bins_[i].count > 0) {
            whole.bins.push_back(i);
            whole.all.add(bins_[i]);
        }
    std::vector<Box> boxes{std::move(whole)};
    const auto error = [](const Box& box) { return box.bins.size() > 1 ? box.all.error() : 0; };
    while (boxes.size() < most_colours) {
        const auto worst = std::ranges::max_element(boxes, {}, error);
        if (!(error(*worst) > 0)) break;
        std::vector<Box> halves = halves_of(*worst);
        if (halves[0].bins.empty() || halves[1].bins.empty()) break; // they differ by rounding alone
        *worst = std::move(halves[0]);
        boxes.push_back(std::move(halves[1]));
    }
    colours_.clear();
    for (const Box& box : boxes) {
        Levels colour{};
        for (std::size_t c = 0; c < 3 && box.all.count > 0; ++c)
            colour[c] = static_cast<std::uint8_t>(std::lround(box.all.mean(c)));
        colours_.push_back(colour);
    }
    choices_.assign(std::size_t{1} << 3 * choice_bits, {});
}

std::uint8_t GifPalette::nearest(const std::array<int, 3>& colour) const {
    std::size_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colours_.size(); ++i)
        if (const int distance = squared_distance(colour, colours_[i]); distance < least) {
            least = distance;
            best = i;
        }
    return static_cast<std::uint8_t>(best);
}

GifPalette::Choice GifPalette::choice_of(const std::array<int, 3>& colour) const {
    Choice choice{nearest(colour), 0, 0, true};
    const Levels& first = colours_[choice.first];
    std::array<int, 3> beyond{};
    for (std::size_t c = 0; c < 3; ++c)
        beyond[c] = 2 * colour[c] - first[c];
    choice.second = nearest(beyond);
    const Levels& second = colours_[choice.second];
    int along = 0, length = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        along += (colour[c] - first[c]) * (second[c] - first[c]);
        length += (second[c] - first[c]) * (second[c] - first[c]);
    }
    if (length > 0) choice.share = static_cast<std::uint8_t>(std::clamp(255 * along / length, 0, 255));
    return choice;
}

std::uint8_t GifPalette::number_of(Levels colour, std::size_t x, std::size_t y) {
    Choice& choice = choices_[number_of_cell(colour, choice_bits)];
    if (!choice.is_known) choice = choice_of({colour[0], colour[1], colour[2]});
    return 64 * choice.share > 255 * threshold(x, y) + 127 ? choice.second : choice.first;
}

} // namespace graftal
