#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

/// For the metadata of pictures and clouds: the command, the name of its model without the folder, and the
/// options that change what is seen, in an order of their own. So the same picture has the same bytes,
/// whoever makes it wherever with however many threads, and says nothing about the machine.
std::string picture_description(const CLI::App& command, const Engine& engine);

} // namespace graftal
