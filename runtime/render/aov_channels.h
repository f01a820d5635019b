#pragma once

#include "runtime/image_files/image_files.h"
#include "runtime/trace/aovs.h"

namespace graftal {

/// The channels of an EXR for AOVs, as docs/native.md describes them: A, coverage, Z, normal.X, normal.Y,
/// normal.Z, albedo.R, albedo.G, albedo.B, id and levels. The tag `graftal:ids` names the objects that are
/// seen, one "NUMBER NAME" a line. Without `alpha` there is no A, for the picture has it.
MoreChannels aov_channels(const AovPicture& aovs, const ObjectNumbers& numbers, bool alpha = true);

} // namespace graftal
