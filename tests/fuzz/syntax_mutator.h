#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/syntax_tree.h"
#include "tests/property/random_graph.h"

namespace graftal::fuzz {

/// Changes texts by their syntax trees: parts are taken out, doubled, exchanged, put in the place of others
/// of their kind, nested and given other numbers; statements of texts seen before are spliced in.
class SyntaxMutator {
  public:
    /// The text with one to eight changes, and never longer than `most` bytes; "" if it has no tree, or
    /// nothing could be changed within that length. Deterministic in all texts and choices so far.
    std::string mutate(std::string_view text, std::size_t most, testing::Choices& choices);

    /// Keeps statements of the text, for splicing.
    void learn(std::string_view text, testing::Choices& choices);

  private:
    struct Kept {
        Part part = Part::text;
        std::string key;
        std::string within;
        std::string text;
    };

    std::string edit(const std::string& text, testing::Choices& choices) const;
    const Kept* kept_like(const SyntaxNode& node, testing::Choices& choices) const;

    std::vector<Kept> kept_;
};

} // namespace graftal::fuzz
