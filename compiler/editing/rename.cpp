#include "compiler/editing/rename.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "compiler/editing/names/names.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lsys/parse/scanner.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/printable.h"

namespace graftal {

namespace {

bool is_module_symbol(std::string_view name) {
    return name.size() == 1 ? turtle_command(name) == TurtleCommand::none : can_name_module(name);
}

/// The fault of a name by itself, or "".
std::string fault_of(std::string_view name, NameKind kind) {
    const bool digits = kind == NameKind::module && name.size() == 1 && name[0] >= '0' && name[0] <= '9';
    if (!digits && (name.empty() || lsys_name(name) != name))
        return fmt::format("'{}' is no name: write letters, digits and '_', and begin with no digit.",
                           escaped(name, 40));
    if (name.size() > max_lsys_symbol)
        return fmt::format("A name has at most {} characters here.", max_lsys_symbol);
    if (kind == NameKind::module && !is_module_symbol(name))
        return fmt::format("'{}' has a meaning of its own in strings.", name);
    const bool placed = kind == NameKind::object || kind == NameKind::model || kind == NameKind::block ||
                        kind == NameKind::map;
    if (placed && is_reserved_name(name)) return fmt::format("'{}' is a primitive.", name);
    if (name == "pi" && kind != NameKind::module) return "'pi' is a constant of every model.";
    return {};
}

/// Each place of each name, with what it is the name of: (place, kind, name, place that it belongs to).
using Reading = std::vector<std::tuple<std::uint32_t, NameKind, std::string, std::uint32_t>>;

/// `place`: where a place of the text counts as; UINT32_MAX: not at all.
template<typename PlaceOf, typename NameOf>
Reading reading(const std::vector<NamedThing>& things, const PlaceOf& place_of, const NameOf& name_of_thing) {
    Reading all;
    for (const NamedThing& thing : things) {
        std::uint32_t home = UINT32_MAX;
        for (const auto* places : {&thing.definitions, &thing.uses})
            for (const Span span : *places)
                home = std::min(home, place_of(span.begin));
        for (const auto* places : {&thing.definitions, &thing.uses})
            for (const Span span : *places)
                if (const std::uint32_t place = place_of(span.begin); place != UINT32_MAX)
                    all.emplace_back(place, thing.kind, name_of_thing(thing), home);
    }
    std::ranges::sort(all);
    return all;
}

/// Says where a place of the text lies after edits that are in order.
class Moves {
  public:
    explicit Moves(const std::vector<TextEdit>& edits) : edits_(edits) {
        for (const TextEdit& edit : edits)
            shifts_.push_back(shifts_.back() + static_cast<std::int64_t>(edit.text.size()) -
                              (edit.end - edit.begin));
    }
    /// Requires a place that is not inside of an edit.
    std::uint32_t operator()(std::uint32_t place) const {
        const auto behind = std::ranges::upper_bound(edits_, place, {}, &TextEdit::end);
        return static_cast<std::uint32_t>(place + shifts_[static_cast<std::size_t>(behind - edits_.begin())]);
    }

  private:
    const std::vector<TextEdit>& edits_;
    std::vector<std::int64_t> shifts_ = {0}; ///< by the number of edits before
};

/// The declaration that a long name of a module needs, on a line before the axiom; nothing where none is.
std::optional<TextEdit> declaration(const Document& document, const NamedThing& thing,
                                    std::string_view name) {
    for (const LsysBlock& block : document.lsys()->blocks) {
        if (block.name.span.begin != thing.scope.begin || !block.axiom) continue;
        const std::string_view text = document.text();
        const std::uint32_t axiom = block.axiom->span.begin;
        const std::size_t line = axiom == 0 ? 0 : text.rfind('\n', axiom - 1) + 1;
        const std::string_view indent = text.substr(line, axiom - line);
        if (indent.find_first_not_of(" \t") != std::string_view::npos) return std::nullopt;
        return TextEdit{axiom, axiom, fmt::format("modules {}\n{}", name, indent)};
    }
    return std::nullopt;
}

bool is_declared(const Document& document, const NamedThing& thing) {
    for (const LsysBlock& block : document.lsys()->blocks)
        for (const Name& name : block.modules)
            if (std::ranges::count(thing.definitions, name.span) > 0) return true;
    return false;
}

} // namespace

Span renamable(const Document& document, std::uint32_t offset) {
    const std::vector<NamedThing> things = names_of(document);
    const NamedThing* const thing = thing_at(things, offset);
    if (!thing || thing->definitions.empty()) return {};
    for (const auto* places : {&thing->definitions, &thing->uses})
        for (const Span place : *places)
            if (place.begin <= offset && offset <= place.end) return place;
    return {};
}

Renaming rename(const Document& document, std::uint32_t offset, std::string_view name) {
    if (document.findings().has_errors())
        return {{}, "Mend the errors of the text first: its names are not all known."};
    const std::vector<NamedThing> things = names_of(document);
    const NamedThing* const thing = thing_at(things, offset);
    if (!thing) return {{}, "There is no name."};
    if (thing->definitions.empty())
        return {{},
                thing->whole.known() ? fmt::format("'{}' is known by its number: write a label and a colon "
                                                   "before its row first.",
                                                   thing->name)
                                     : fmt::format("'{}' is not a name that this text gives.", thing->name)};
    if (thing->name == name) return {};
    if (thing->kind == NameKind::module && turtle_command(thing->name) != TurtleCommand::none)
        return {{}, fmt::format("'{}' is a symbol of the turtle.", thing->name)};
    if (std::string fault = fault_of(name, thing->kind); !fault.empty()) return {{}, std::move(fault)};

    Renaming result;
    for (const auto* places : {&thing->definitions, &thing->uses})
        for (const Span place : *places)
            result.edits.push_back({place.begin, place.end, std::string(name)});
    std::uint32_t declared_begin = 0, declared_end = 0; // in the text after the edits
    if (thing->kind == NameKind::module && name.size() > 1 && !is_declared(document, *thing)) {
        std::optional<TextEdit> declared = declaration(document, *thing, name);
        if (!declared) return {{}, fmt::format("'{}' needs a line 'modules {}' in its block.", name, name)};
        result.edits.push_back(std::move(*declared));
    }
    std::ranges::stable_sort(result.edits, {}, &TextEdit::begin);
    const Moves moved(result.edits);
    for (const TextEdit& edit : result.edits)
        if (edit.begin == edit.end) {
            declared_end = moved(edit.begin);
            declared_begin = declared_end - static_cast<std::uint32_t>(edit.text.size());
        }

    const Document after(document.name(), applied(document.text(), result.edits));
    const auto new_place = [&](std::uint32_t place) {
        return declared_begin <= place && place < declared_end ? UINT32_MAX : place;
    };
    const auto new_name = [&](const NamedThing& other) {
        return &other == thing ? std::string(name) : other.name;
    };
    const auto same_name = [](const NamedThing& other) { return other.name; };
    if (after.findings().has_errors() ||
        reading(things, moved, new_name) != reading(names_of(after), new_place, same_name))
        return {{}, fmt::format("'{}' already has a meaning where '{}' stands.", name, thing->name)};
    return result;
}

} // namespace graftal
