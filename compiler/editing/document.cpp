#include "compiler/editing/document.h"

#include <utility>

#include "compiler/inst/parse/parser.h"
#include "compiler/languages/languages.h"
#include "compiler/lsys/parse/parser.h"
#include "compiler/rifs/parser.h"
#include "compiler/support/path_text.h"

namespace graftal {

Document::Document(std::string name, std::string text) : name_(std::move(name)) {
    const FileId file = sources_.add(name_, std::move(text));
    language_ = language_with_ending(extension_of(name_), languages());
    if (!language_) return;
    if (language_->extension == "lsys")
        tree_ = parse_lsys(sources_, file, findings_);
    else if (language_->extension == "rifs")
        tree_ = parse_rifs(sources_, file, findings_);
    else
        tree_ = parse_inst(sources_, file, findings_);
}

Span Document::span_of(std::string_view part) const {
    const auto begin = static_cast<std::uint32_t>(part.data() - text().data());
    return {0, begin, begin + static_cast<std::uint32_t>(part.size())};
}

} // namespace graftal
