#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/detail/graph/cut_graph.h"
#include "compiler/scene/scene.h"
#include "runtime/trace/mattes.h"

namespace graftal {

// Mattes in an EXR by the Cryptomatte specification 1.2.0 (Friedman and Jones): the layers CryptoObject and
// CryptoMaterial, each with three channels of two ids and their shares, whose bits are those of 32-bit
// floats.

/// Names of the channels of both layers, CryptoObject00.R to CryptoMaterial02.A.
std::vector<std::string> matte_channel_names();

/// Appends a pixel's samples of these channels.
void append_mattes(const PixelMattes& mattes, std::vector<float>& samples);

/// The tags that name the layers and the ids that are seen, as "cryptomatte/..." and text. The names are
/// those of the graph and of the ground.
std::vector<std::pair<std::string, std::string>> matte_tags(const std::vector<PixelMattes>& picture,
                                                            const CutGraph& cut, const View& view);

} // namespace graftal
