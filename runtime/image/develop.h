#pragma once

#include "compiler/light/film.h"
#include "compiler/support/tint.h"
#include "runtime/image/image.h"

namespace graftal {

/// A grey light as a film shows it, sRGB encoded (IEC 61966-2-1), in [0, 1]: times the exposure. A soft film
/// shows x > 1/2 as 1/2 + (1 - e^(1 - 2 x)) / 2, which leaves dark parts alone and never reaches 1.
double developed(double light, const Film& film);

/// Linear light into the samples of a PNG: each component by developed(), after the gains that make the
/// film's white temperature white. A film that is not plain() is dithered by half a step of the format, so
/// that slow gradients have no bands; where a value needs none it stays. Alpha stays. Every engine's
/// pictures, and those of random points, go through here.
class Developer {
  public:
    /// `left` and `top`: where the picture lies in the whole that it is a part of, in pixels.
    Developer(const Film& film, SampleFormat format, int left = 0, int top = 0);

    /// Rows `first` to `end`; threads may share it for rows of their own.
    void develop(Image& picture, int first, int end) const;

  private:
    Film film_;
    int largest_level_;
    int left_, top_;
    Rgb gains_{1.0};
};

} // namespace graftal
