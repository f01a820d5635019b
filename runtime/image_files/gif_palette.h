#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace graftal {

/// A colour of 8 bits a channel.
using Levels = std::array<std::uint8_t, 3>;

/// A few colours for many, the same for all pictures of a film.
class GifPalette {
  public:
    /// The most that leave a number for clear pixels.
    static constexpr std::size_t most_colours = 255;

    /// Counts colours of a picture; before make().
    void count(std::span<const Levels> pixels);
    /// Makes the colours: boxes in the cube of colours, each the one with the largest squared error cut at
    /// its mean across the axis of the largest variance (after X. Wu, Graphics Gems II, 1991).
    void make();

    const std::vector<Levels>& colours() const { return colours_; }

    /// The number of the colour for a pixel there: one of two on both sides of its own, by a threshold that
    /// depends on the place alone (ordered dithering), so that what does not change stays still.
    std::uint8_t number_of(Levels colour, std::size_t x, std::size_t y);

  private:
    /// Colours that differ in their last bits alone.
    struct Bin {
        std::uint64_t count = 0;
        std::array<std::uint64_t, 3> sum{}, squares{};

        void add(const Bin& other);
        double variance(std::size_t channel) const; ///< times the count
        double error() const;
        double mean(std::size_t channel) const;
    };
    struct Box {
        std::vector<std::uint32_t> bins;
        Bin all;
    };
    /// The two colours of a pixel, and the share of the second in 255ths.
    struct Choice {
        std::uint8_t first = 0, second = 0, share = 0;
        bool is_known = false;
    };

    std::vector<Box> halves_of(const Box& box) const;
    std::uint8_t nearest(const std::array<int, 3>& colour) const;
    Choice choice_of(const std::array<int, 3>& colour) const;

    std::vector<Bin> bins_;
    std::vector<Levels> colours_;
    std::vector<Choice> choices_; ///< by colour, without its last bit
};

} // namespace graftal
