#include "compiler/editing/text_edit.h"

#include <algorithm>

#include "compiler/support/check.h"

namespace graftal {

std::string applied(std::string_view text, std::vector<TextEdit> edits) {
    std::ranges::stable_sort(edits, {}, &TextEdit::begin);
    std::string result;
    std::size_t at = 0;
    for (const TextEdit& edit : edits) {
        GRAFTAL_CHECK(edit.begin >= at && edit.end >= edit.begin && edit.end <= text.size(),
                      "edits overlap, or lie outside of the text");
        result += text.substr(at, edit.begin - at);
        result += edit.text;
        at = edit.end;
    }
    result += text.substr(at);
    return result;
}

} // namespace graftal
