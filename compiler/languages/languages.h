#pragma once

#include <span>

#include "compiler/lower/language.h"

namespace graftal {

/// The languages that models are written in. To add one: a folder like compiler/rifs and a row of this table.
std::span<const Language> languages();

} // namespace graftal
