#pragma once

#include "compiler/support/files.h"

namespace graftal {

/// The files of the operating system.
const Files& disk_files();

} // namespace graftal
