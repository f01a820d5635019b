#include "compiler/rifs/language.h"

#include <utility>

#include "compiler/rifs/lower.h"
#include "compiler/rifs/parser.h"

namespace graftal {

namespace {

class RifsTree final : public ModelTree {
  public:
    explicit RifsTree(RifsFile file) : file_(std::move(file)) {}

    InnerStatements inner_statements() const override { return {file_.statements, {}}; }
    std::optional<Graph> lower(Lowering& lowering) const override { return lower_rifs(file_, lowering); }

  private:
    RifsFile file_;
};

std::unique_ptr<const ModelTree> parse(const SourceMap& sources, FileId file, const ForeignWords& foreign,
                                       Diagnostics& diagnostics) {
    return std::make_unique<RifsTree>(parse_rifs(sources, file, diagnostics, foreign));
}

} // namespace

Language rifs_language() {
    return {
        .extension = "rifs", .keywords = rifs_keywords, .inner_keywords = {"map", "codes"}, .parse = parse};
}

} // namespace graftal
