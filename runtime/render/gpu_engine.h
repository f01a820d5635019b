#pragma once

#include "runtime/render/render.h"

namespace graftal {

/// The graph traced by a GPU (runtime/gpu), for models and light that its kernel knows; others, and pictures
/// whose device fails, are drawn by the native engine, and a note says why.
extern const Engine gpu_engine;

/// Whether this machine has a device that is not its processors by software.
bool has_gpu();

} // namespace graftal
