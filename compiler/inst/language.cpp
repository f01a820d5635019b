#include "compiler/inst/language.h"

#include <utility>

#include "compiler/inst/lower.h"
#include "compiler/inst/parse/parser.h"

namespace graftal {

namespace {

class InstTree final : public ModelTree {
  public:
    explicit InstTree(InstModule file) : file_(std::move(file)) {}

    InnerStatements inner_statements() const override { return {file_.scene, {}}; }
    std::optional<Graph> lower(Lowering& lowering) const override { return lower_inst(file_, lowering); }

  private:
    InstModule file_;
};

std::unique_ptr<const ModelTree> parse(const SourceMap& sources, FileId file, const ForeignWords& foreign,
                                       Diagnostics& diagnostics) {
    return std::make_unique<InstTree>(parse_inst(sources, file, diagnostics, foreign));
}

} // namespace

Language inst_language() {
    return {.extension = "inst", .keywords = inst_keywords, .inner_keywords = {}, .parse = parse};
}

} // namespace graftal
