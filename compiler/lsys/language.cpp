#include "compiler/lsys/language.h"

#include <utility>

#include "compiler/lsys/lower.h"
#include "compiler/lsys/parse/parser.h"
#include "compiler/lsys/parse/scanner.h"

namespace graftal {

namespace {

class LsysTree final : public ModelTree {
  public:
    explicit LsysTree(LsysFile file) : file_(std::move(file)) {}

    InnerStatements inner_statements() const override {
        const LsysBlock* const main = main_block(file_);
        return {file_.statements, main ? main->lets : std::vector<SceneStatement>()};
    }
    std::optional<Graph> lower(Lowering& lowering) const override { return lower_lsys(file_, lowering); }

  private:
    LsysFile file_;
};

std::unique_ptr<const ModelTree> parse(const SourceMap& sources, FileId file, const ForeignWords& foreign,
                                       Diagnostics& diagnostics) {
    return std::make_unique<LsysTree>(parse_lsys(sources, file, diagnostics, foreign));
}

} // namespace

Language lsys_language() {
    return {.extension = "lsys",
            .keywords = lsys_file_keywords,
            .inner_keywords = {lsys_keywords().begin(), lsys_keywords().end()},
            .has_time = true,
            .parse = parse};
}

} // namespace graftal
