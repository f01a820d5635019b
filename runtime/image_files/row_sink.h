#pragma once

#include <cstdint>
#include <string>

namespace graftal {

/// Reading takes time by the size of the file's picture, whatever is kept of it: larger ones are refused.
inline constexpr std::uint64_t most_file_texels = 1u << 28;

/// Takes a picture row by row, the top one first, as it comes out of its file: a small file may hold a huge
/// picture, and who takes it decides what to keep of it.
class RowSink {
  public:
    virtual ~RowSink() = default;
    /// Called once, before the rows, with what the head of the file says; at most four channels. "" to go on,
    /// else the complaint that the reading ends with.
    virtual std::string begin(int width, int height, int channels) = 0;
    /// width * channels samples, as Image has them.
    virtual void take(const float* samples) = 0;
};

/// The size of a picture, without its samples.
struct RowShape {
    int width = 0;
    int height = 0;
    int channels = 0;
};

/// Gives a picture row by row, the top one first, to what writes it: nobody holds all of it.
class RowSource {
  public:
    virtual ~RowSource() = default;
    /// Fills in width * channels samples. "", or what went wrong; no row is asked for after that.
    virtual std::string give(float* samples) = 0;
};

} // namespace graftal
