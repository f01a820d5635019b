#pragma once

#include "compiler/light/film.h"
#include "runtime/image/image.h"

namespace graftal {

/// A grey light as a film shows it, sRGB encoded, in [0, 1]: times the exposure; a soft film shows x > 1/2 as
///     1/2 + (1 - e^(1 - 2 x)) / 2,
/// which leaves what is dark alone and never reaches 1; encoded as IEC 61966-2-1 says.
double developed(double light, const Film& film);

/// Linear light into the samples of an 8-bit picture, rows `first` to `end`: each component by developed(),
/// after the gains that make the film's white temperature white. A film that is not plain() is dithered by
/// half a step, so that slow gradients have no bands; where a value needs none it stays. Alpha stays. Every
/// engine's pictures go through here.
void develop_rows(Image& picture, const Film& film, int first, int end);

} // namespace graftal
