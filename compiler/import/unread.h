#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace graftal {

/// A kind of text that graftal knows, and does not read.
struct UnreadKind {
    std::string_view name;    ///< "a Python program"
    std::string_view instead; ///< the nearest thing that graftal reads; "" for none
    std::size_t begin = 0;    ///< of the words that tell it
};

/// The kind of a text, in a time linear in it. A language of programs with L-systems in them is known for
/// sure, although their blocks may look like another format's; `known_to_none`: other kinds are meant, too.
std::optional<UnreadKind> unread_kind(std::string_view text, bool known_to_none);

} // namespace graftal
