#pragma once

#include <cstdint>
#include <string_view>

namespace graftal {

/// What a symbol tells the turtle (docs/language.md, "The turtle").
enum class TurtleCommand : std::uint8_t {
    none,            ///< a letter that the turtle passes over
    draw,            ///< F
    draw_unrecorded, ///< G: leaves no vertex in a polygon
    move,            ///< f
    move_unrecorded, ///< g
    turn_left,       ///< +
    turn_right,      ///< -
    pitch_down,      ///< &
    pitch_up,        ///< ^
    roll_left,       ///< backslash
    roll_right,      ///< /
    turn_back,       ///< |
    level,           ///< $
    width,           ///< !
    colour_up,       ///< ; and '
    colour_down,     ///< ,
    tropism,         ///< T
    open_branch,     ///< [
    close_branch,    ///< ]
    cut,             ///< %
    open_polygon,    ///< {
    close_polygon,   ///< }
    vertex,          ///< .
    sphere,          ///< @O
    disc,            ///< @o and @c
    model,           ///< ~NAME
    start_cylinder,  ///< @Gs
    control_point,   ///< @Gc
    end_cylinder,    ///< @Ge
};

/// The command of a symbol as strings write it; `none` for what has no meaning.
TurtleCommand turtle_command(std::string_view symbol);

} // namespace graftal
