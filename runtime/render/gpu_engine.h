#pragma once

#include <string>

#include "runtime/render/render.h"

namespace graftal {

/// The graph traced by a GPU (runtime/gpu), for models and light that its kernel knows; others, and pictures
/// whose device fails, are drawn by the native engine, and a note says why.
extern const Engine gpu_engine;

/// Why there is no graphics card; empty where there is one. Nobody who asks for a card waits for the
/// processors to play one.
std::string why_no_card();

/// Whether this machine has a device that is not its processors by software.
bool has_gpu();

} // namespace graftal
