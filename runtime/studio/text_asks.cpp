#include "runtime/studio/text_asks.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "runtime/studio/message_reader.h"

namespace graftal {

bool is_about_text(const std::string& what) {
    constexpr std::string_view known[] = {"complete", "hover", "definition", "rename", "format",
                                          "map",      "pull",  "digraph",    "vary"};
    return std::ranges::find(known, what) != std::end(known);
}

nlohmann::json answer_about_text(const std::string& what, const nlohmann::json&, const StudioState&) {
    // The place where compiler/editing answers.
    throw BadMessage(fmt::format("'{}': not yet", what));
}

} // namespace graftal
