#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace graftal {

/// The command that a symbol gives the turtle (docs/language.md, "The turtle").
enum class TurtleCommand : std::uint8_t {
    none, ///< a letter that the turtle passes over
    draw,
    draw_always,     ///< in polygons too, and leaves no vertex in them
    draw_unrecorded, ///< leaves no vertex in a polygon
    move,
    move_unrecorded,
    turn_left,
    turn_right,
    pitch_down,
    pitch_up,
    roll_left,
    roll_right,
    turn_back,
    level,
    width,
    colour_up,
    colour_down,
    tropism,
    open_branch,
    close_branch,
    cut,
    open_polygon,
    close_polygon,
    vertex,
    sphere,
    disc,
    model, ///< ~NAME
    start_cylinder,
    control_point,
    end_cylinder,
    scale_by,      ///< all lengths, and widths that are set from here on
    scale_down_by, ///< the inverse
    step_by,       ///< the lengths that are not written
    width_by,
    angle_by,      ///< of turns without a parameter
    exchange,      ///< the axes with the second ones
    bend_down,     ///< pitches, the more level it heads
    reverse_turns, ///< exchanges left and right in turns, not in rolls
    flip,          ///< mirrors the turtle: left is right
    widen,         ///< adds to the width
    stiffen,       ///< adds to the elasticity
    set_tropism,   ///< the elasticity of one of several
    go_to,         ///< a place of the world
    head_to,       ///< a direction of the world
    // Queries: derivation sets their parameters (walk/queries.h).
    ask_place,
    ask_heading,
    ask_up,
    ask_left,
    ask_environment,
};

/// When tropisms bend the turtle.
enum class Bending : std::uint8_t { after_segments, after_moves, before_moves };

/// The action of a tropism.
struct TropismKind {
    double toward = 1; ///< cosine of the angle with the direction that headings tend to
    double across = 0; ///< its sine
    bool twists =
        false; ///< turns the turtle about its heading, until z is near the direction, and bends nothing

    bool is_plain() const { return across == 0 && !twists; }
};

/// Tropisms of a block beside its first.
inline constexpr std::size_t most_other_tropisms = 7;

struct TurtleSymbol {
    std::string_view text;
    TurtleCommand command;
};

/// The symbols that have a meaning. A new one is a row here, and a case in turtle.cpp.
inline constexpr TurtleSymbol turtle_symbols[] = {
    {"F", TurtleCommand::draw},
    {"G", TurtleCommand::draw_unrecorded},
    {"f", TurtleCommand::move},
    {"g", TurtleCommand::move_unrecorded},
    {"+", TurtleCommand::turn_left},
    {"-", TurtleCommand::turn_right},
    {"&", TurtleCommand::pitch_down},
    {"^", TurtleCommand::pitch_up},
    {"\\", TurtleCommand::roll_left},
    {"/", TurtleCommand::roll_right},
    {"|", TurtleCommand::turn_back},
    {"$", TurtleCommand::level},
    {"!", TurtleCommand::width},
    {";", TurtleCommand::colour_up},
    {"'", TurtleCommand::colour_up},
    {",", TurtleCommand::colour_down},
    {"T", TurtleCommand::tropism},
    {"[", TurtleCommand::open_branch},
    {"]", TurtleCommand::close_branch},
    {"%", TurtleCommand::cut},
    {"{", TurtleCommand::open_polygon},
    {"}", TurtleCommand::close_polygon},
    {".", TurtleCommand::vertex},
    {"@O", TurtleCommand::sphere},
    {"@o", TurtleCommand::disc},
    {"@c", TurtleCommand::disc},
    {"~", TurtleCommand::model},
    {"@Gs", TurtleCommand::start_cylinder},
    {"@Gc", TurtleCommand::control_point},
    {"@Ge", TurtleCommand::end_cylinder},
    {"@Di", TurtleCommand::scale_by},
    {"@Dd", TurtleCommand::scale_down_by},
    {"@S", TurtleCommand::step_by},
    {"@W", TurtleCommand::width_by},
    {"@A", TurtleCommand::angle_by},
    {"@X", TurtleCommand::exchange},
    {"@F", TurtleCommand::flip},
    {"@B", TurtleCommand::bend_down},
    {"@N", TurtleCommand::reverse_turns},
    {"@E", TurtleCommand::draw_always},
    {"@I", TurtleCommand::widen},
    {"@K", TurtleCommand::stiffen},
    {"@T", TurtleCommand::set_tropism},
    {"@M", TurtleCommand::go_to},
    {"@R", TurtleCommand::head_to},
    {"?P", TurtleCommand::ask_place},
    {"?H", TurtleCommand::ask_heading},
    {"?U", TurtleCommand::ask_up},
    {"?L", TurtleCommand::ask_left},
    {"?E", TurtleCommand::ask_environment},
};

/// The command of a symbol as strings write it; `none` for what has no meaning.
TurtleCommand turtle_command(std::string_view symbol);

} // namespace graftal
