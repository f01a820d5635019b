#include "compiler/lsys/parse/turtle_command.h"

#include <algorithm>
#include <iterator>

namespace graftal {

TurtleCommand turtle_command(std::string_view symbol) {
    if (symbol.starts_with('~')) return TurtleCommand::model;
    const auto* const found = std::ranges::find(turtle_symbols, symbol, &TurtleSymbol::text);
    return found == std::end(turtle_symbols) ? TurtleCommand::none : found->command;
}

} // namespace graftal
