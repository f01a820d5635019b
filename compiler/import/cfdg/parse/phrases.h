#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/cfdg/parse/tokens.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

/// The parts of statements: the tokens of a file, its adjustments and expressions. Functions that parse give
/// nothing, or false, after an error.
class Phrases {
  protected:
    explicit Phrases(const ForeignFile& file) : file_(file), tokens_(tokenize(file)) {}

    static constexpr int deepest = 200; ///< of braces and brackets

    const Token& peek(std::size_t ahead = 0) const {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    bool at_end() const { return peek().kind == TokenKind::end; }
    bool at(std::string_view text) const { return peek().is(text); }

    const Token& next() {
        const Token& token = peek();
        if (at_ + 1 < tokens_.size()) ++at_;
        return token;
    }

    bool accept(std::string_view text) {
        if (!at(text)) return false;
        next();
        return true;
    }

    bool expected(std::string_view what) {
        file_.diagnostics.error(peek().span,
                                fmt::format("expected {}, found {}", what,
                                            at_end() ? peek().text : fmt::format("'{}'", peek().text)));
        return false;
    }

    bool expect(std::string_view text) { return accept(text) || expected(fmt::format("'{}'", text)); }

    /// Braces and brackets nest only so deep: the parser, and what walks the tree, recurs.
    class Level {
      public:
        explicit Level(Phrases& phrases) : phrases_(phrases), good_(++phrases.depth_ <= deepest) {
            if (good_) return;
            if (!std::exchange(phrases.too_deep_, true))
                phrases.file_.diagnostics.error(
                    phrases.peek().span, fmt::format("braces and brackets nest more than {} deep", deepest));
        }
        ~Level() { --phrases_.depth_; }
        Level(const Level&) = delete;
        Level& operator=(const Level&) = delete;
        explicit operator bool() const { return good_; }

      private:
        Phrases& phrases_;
        bool good_;
    };

    bool parse_modification(Modification& modification);
    bool version_2() const;
    bool parse_adjustment(Modification& modification);
    std::string_view word_of(std::string_view word) const;
    bool begins_value() const;
    std::optional<Expr> parse_value();
    std::optional<Expr> parse_list();
    static int level_of(const Token& token);
    static Expr binary(const Token& sign, Expr left, Expr right);
    std::optional<Expr> parse_expression(int least = 1);
    bool chain_too_long(const Expr& expression);
    std::optional<Expr> parse_unary(bool tight);
    std::optional<Expr> parse_let(Expr let);

    const ForeignFile& file_;
    std::vector<Token> tokens_;
    std::size_t at_ = 0;

  private:
    int depth_ = 0;
    bool too_deep_ = false;
    std::size_t size_ = 0;
    mutable std::optional<bool> is_version_2_;
};

} // namespace graftal::cfdg
