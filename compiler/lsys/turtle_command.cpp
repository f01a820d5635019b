#include "compiler/lsys/turtle_command.h"

#include <algorithm>
#include <array>
#include <utility>

namespace graftal {

namespace {

using enum TurtleCommand;

constexpr std::array<std::pair<std::string_view, TurtleCommand>, 30> commands = {{
    {"F", draw},
    {"G", draw_unrecorded},
    {"f", move},
    {"g", move_unrecorded},
    {"+", turn_left},
    {"-", turn_right},
    {"&", pitch_down},
    {"^", pitch_up},
    {"\\", roll_left},
    {"/", roll_right},
    {"|", turn_back},
    {"$", level},
    {"!", width},
    {";", colour_up},
    {"'", colour_up},
    {",", colour_down},
    {"T", tropism},
    {"[", open_branch},
    {"]", close_branch},
    {"%", cut},
    {"{", open_polygon},
    {"}", close_polygon},
    {".", vertex},
    {"@O", sphere},
    {"@o", disc},
    {"@c", disc},
    {"~", model},
    {"@Gs", start_cylinder},
    {"@Gc", control_point},
    {"@Ge", end_cylinder},
}};

} // namespace

TurtleCommand turtle_command(std::string_view symbol) {
    if (symbol.starts_with('~')) return model;
    const auto found =
        std::ranges::find(commands, symbol, &std::pair<std::string_view, TurtleCommand>::first);
    return found == commands.end() ? none : found->second;
}

} // namespace graftal
