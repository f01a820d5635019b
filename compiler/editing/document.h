#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "compiler/inst/parse/ast.h"
#include "compiler/lower/language.h"
#include "compiler/lsys/parse/ast.h"
#include "compiler/rifs/ast.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// A model's text with its tree, as far as it can be read: what the functions of this room are asked about.
/// All places are bytes of the text, in the file 0 of `sources()`. Moving one keeps its views valid.
class Document {
  public:
    using Tree = std::variant<std::monostate, LsysFile, RifsFile, InstModule>;

    /// Parses the text by the language of the name's ending; with another ending there is no tree. Requires
    /// a text whose lines end with '\n' (support/text_encoding.h), shorter than 2^32 - 1 bytes.
    Document(std::string name, std::string text);

    const std::string& name() const { return name_; }
    std::string_view text() const { return sources_.text(FileId{0}); }
    std::string_view text(Span span) const { return sources_.text(span); }
    /// Null where the ending is none of ours.
    const Language* language() const { return language_; }
    const Tree& tree() const { return tree_; }
    /// Findings of the parser alone.
    const Diagnostics& findings() const { return findings_; }
    const SourceMap& sources() const { return sources_; }

    const LsysFile* lsys() const { return std::get_if<LsysFile>(&tree_); }
    const RifsFile* rifs() const { return std::get_if<RifsFile>(&tree_); }
    const InstModule* inst() const { return std::get_if<InstModule>(&tree_); }

    /// The place of a view of the text. Requires one.
    Span span_of(std::string_view part) const;

  private:
    std::string name_;
    SourceMap sources_;
    Diagnostics findings_;
    const Language* language_ = nullptr;
    Tree tree_;
};

} // namespace graftal
