#include "compiler/editing/complete.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "compiler/editing/names/names.h"
#include "compiler/editing/place.h"
#include "compiler/editing/words.h"
#include "compiler/lower/named_materials.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// The names that a word before them asks for.
enum class Wanted : std::uint8_t { values, materials, blocks, maps, objects, modules, nothing };

std::string_view kind_of(WordPlace place) {
    if (place == WordPlace::value) return "function";
    if (place == WordPlace::primitive) return "primitive";
    return place == WordPlace::turtle ? "symbol" : "keyword";
}

class Completer {
  public:
    Completer(const Document& document, std::uint32_t offset)
        : document_(document), offset_(offset), place_(place_at(document, offset)) {
        from_ = std::min(place_.word.begin, offset);
        if (place_.string) from_ = offset;
        prefix_ = document.text().substr(from_, offset - from_);
    }

    Completions run() && {
        if (!place_.where.empty()) {
            if (place_.string)
                add_modules();
            else
                add_all();
        }
        return {from_, std::move(items_)};
    }

  private:
    Wanted wanted() const {
        const std::string_view after = place_.after;
        const bool rifs = document_.rifs() != nullptr, inst = document_.inst() != nullptr;
        const WordPlace around = place_.where.back();
        if (after == "material" || after == "colors" || (around == WordPlace::material && after == "from"))
            return Wanted::materials;
        if (rifs && after == "from") return Wanted::blocks;
        if (rifs && (after == "follow" || after == "start" || after == "->" || after == "except") &&
            around != WordPlace::orbit)
            return Wanted::maps;
        if (after == "condense" || after == "terminal" || after == "union" || after == "intersection" ||
            after == "difference" || after == "instance" || after == "scatter" || after == "~" ||
            around == WordPlace::primitive)
            return Wanted::objects;
        if (after == "rifs" || after == "lsys" || after == "object" || after == "use" || after == "map" ||
            after == "let" || after == "inner" || after == "orbit" || after == "canonical")
            return Wanted::nothing; // a new name
        if (inst && around == WordPlace::inst_body && place_.begins) return Wanted::objects;
        return Wanted::values;
    }

    void add_all() {
        const Wanted names = wanted();
        if (names == Wanted::nothing) {
            if (place_.after == "canonical") add_word(WordPlace::inst_file, "object");
            return;
        }
        const bool values = place_.value && names == Wanted::values;
        if (values || names != Wanted::values) add_names(names);
        if (names == Wanted::objects) add_words(WordPlace::primitive);
        if (names == Wanted::materials)
            for (const Material& material : named_materials())
                add(material.name, "material", "a material that every model knows");
        const bool bare = names == Wanted::objects && place_.where.back() == WordPlace::inst_body;
        if (names != Wanted::values && !(bare && place_.begins)) return;
        if (place_.begins || !place_.value)
            for (const WordPlace where : place_.where)
                if (where != WordPlace::value) add_words(where);
        if (values) {
            if (place_.where.front() == WordPlace::environment) add_words(WordPlace::environment);
            add_words(WordPlace::value);
        }
    }

    static bool fits(Wanted wanted, NameKind kind) {
        switch (wanted) {
        case Wanted::values:
            return kind == NameKind::let || kind == NameKind::inner || kind == NameKind::parameter ||
                   kind == NameKind::variable || kind == NameKind::local || kind == NameKind::table ||
                   kind == NameKind::function;
        case Wanted::materials:
            return kind == NameKind::material;
        case Wanted::blocks:
            return kind == NameKind::block;
        case Wanted::maps:
            return kind == NameKind::map;
        case Wanted::objects:
            return kind == NameKind::object || kind == NameKind::model || kind == NameKind::block;
        case Wanted::modules:
            return kind == NameKind::module;
        case Wanted::nothing:
            break;
        }
        return false;
    }

    /// Names that are known at the place. A name whose only place is the one that is typed is none.
    void add_names(Wanted wanted) {
        for (const NamedThing& thing : names_of(document_)) {
            const bool known =
                thing.scope.known() && thing.scope.begin <= offset_ && offset_ <= thing.scope.end;
            const bool typed = thing.uses.empty() && thing.definitions.size() == 1 &&
                               thing.definitions.front().begin == from_;
            // In `.rifs`, blocks are no masters.
            const bool master =
                !(document_.rifs() && wanted == Wanted::objects) || thing.kind == NameKind::model;
            if (known && !typed && master && fits(wanted, thing.kind))
                add(thing.name, word_of(thing.kind), one_line(document_.text(thing.whole)));
        }
    }

    static std::string one_line(std::string_view text) {
        constexpr std::size_t most = 80;
        std::string line(text.substr(0, std::min(text.find('\n'), most)));
        if (line.size() < text.size()) line += " ...";
        return line;
    }

    /// In strings, the longest name of a module that the characters before the place begin.
    void add_modules() {
        const std::vector<NamedThing> things = names_of(document_);
        constexpr std::uint32_t most_back = max_lsys_symbol;
        for (std::uint32_t back = std::min(offset_, most_back); back > 0; --back) {
            const std::string_view typed = document_.text().substr(offset_ - back, back);
            const bool begins = std::ranges::any_of(things, [&](const NamedThing& thing) {
                return thing.kind == NameKind::module && thing.name.size() > back &&
                       thing.name.starts_with(typed);
            });
            if (!begins) continue;
            from_ = offset_ - back;
            prefix_ = typed;
            break;
        }
        const std::string_view before = document_.text().substr(0, offset_);
        for (const std::string_view sign : {"@G", "@D", "@", "?"})
            if (prefix_.empty() && before.ends_with(sign)) {
                from_ = offset_ - static_cast<std::uint32_t>(sign.size());
                prefix_ = sign;
            }
        add_names(Wanted::modules);
        add_words(WordPlace::turtle);
    }

    void add_words(WordPlace where) {
        for (const std::string_view word : words_in(where))
            add_word(where, word);
    }

    void add_word(WordPlace where, std::string_view word) {
        const Word* const meaning = word_in(where, word);
        add(word, kind_of(where), meaning ? fmt::format("{}  {}", meaning->form, meaning->doc) : "");
    }

    void add(std::string_view label, std::string_view kind, std::string detail) {
        const bool case_counts = place_.string;
        const std::string_view head = label.substr(0, prefix_.size());
        const bool begins =
            case_counts ? head == prefix_ : in_small_letters(head) == in_small_letters(prefix_);
        if (!begins || !said_.insert(std::string(label)).second) return;
        items_.push_back({std::string(label), std::string(kind), std::move(detail), std::string(label)});
    }

    const Document& document_;
    std::uint32_t offset_;
    Place place_;
    std::uint32_t from_ = 0;
    std::string_view prefix_;
    std::set<std::string> said_;
    std::vector<Completion> items_;
};

} // namespace

Completions complete(const Document& document, std::uint32_t offset) {
    return Completer(document, offset).run();
}

} // namespace graftal
