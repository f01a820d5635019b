#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include "compiler/povray/output.h"
#include "compiler/support/affine.h"

namespace graftal {

/// Writes POV-Ray's scene description language to a sink in large pieces, fast: scenes have millions of
/// numbers. Locale-proof. After the sink has stopped it, writing goes on without effect.
class SdlWriter {
  public:
    explicit SdlWriter(const TextSink& sink);

    SdlWriter& operator<<(std::string_view text) {
        if (text.size() > capacity - used_) return in_pieces(text);
        std::memcpy(buffer_.get() + used_, text.data(), text.size());
        used_ += text.size();
        return *this;
    }
    SdlWriter& operator<<(std::uint64_t number);

    /// At most `digits` significant digits (1 to 12), no trailing zeros; the error is at most half a unit in
    /// the last digit and 1e-15. Requires a finite value.
    SdlWriter& number(double value, int digits);
    /// `<a,b,c>`
    SdlWriter& indices(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    /// `<x,y,z>`
    SdlWriter& vector(Vec3 v, int digits);
    /// `matrix <...>` in POV-Ray's order: the images of the axes, then of the origin. Entries that are
    /// rounding noise (below 1e-13 of the largest) are written as 0.
    SdlWriter& matrix(const Affine& a);

    /// Passes on what is buffered; false if the sink has stopped the writer, now or before.
    bool flush();
    bool stopped() const { return stopped_; }

  private:
    SdlWriter& in_pieces(std::string_view text);
    /// Makes room for `bytes` more, at most `capacity`.
    char* room(std::size_t bytes);
    /// Takes the bytes that were written there, up to `end`.
    SdlWriter& written(const char* end);

    static constexpr std::size_t capacity = 128 * 1024;

    const TextSink& sink_;
    std::unique_ptr<char[]> buffer_;
    std::size_t used_ = 0;
    bool stopped_ = false;
};

} // namespace graftal
