#pragma once

#include "compiler/lsys/parse/ast.h"
#include "compiler/lsys/parse/strings.h"

namespace graftal {

/// Parses the block at `header` into `file`; gives the place behind it. Statements of the file that stand in
/// the block by mistake are reported, and read.
std::size_t parse_lsys_block(const LsysHeader& header, LsysText& text, LsysFile& file);

} // namespace graftal
