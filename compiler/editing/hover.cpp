#include "compiler/editing/hover.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/analysis/counts.h"
#include "compiler/editing/names/names.h"
#include "compiler/editing/place.h"
#include "compiler/lower/named_materials.h"
#include "compiler/support/number.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

/// Counting the parts of one object walks over its graph.
constexpr std::size_t most_objects_counted = 2000;
constexpr std::size_t most_instances_counted = 100'000;

std::string short_number(double value) {
    std::string text;
    append_number(text, value, 4);
    return text;
}

std::string corner(Vec3 v) {
    return fmt::format("({}, {}, {})", short_number(v.x), short_number(v.y), short_number(v.z));
}

const Object* object_named(const Graph& graph, const std::string& name) {
    const auto found = std::ranges::find(graph.objects, name, &Object::name);
    if (found != graph.objects.end()) return &*found;
    const auto qualified = std::ranges::find_if(
        graph.objects, [&](const Object& object) { return object.name.ends_with("." + name); });
    return qualified == graph.objects.end() ? nullptr : &*qualified;
}

/// "Box from ... to ... 12 primitives. Dimension 1.585."
std::string size_of(const std::string& name, const AnalysedModel& model) {
    const Object* const object = object_named(model.graph, name);
    if (!object) return {};
    const auto id = static_cast<ObjectId>(object - model.graph.objects.data());
    std::string text;
    if (id < model.bounds.size() && !model.bounds[id].box.empty()) {
        const Box& box = model.bounds[id].box;
        text += fmt::format("Box from {} to {}. ", corner(box.min), corner(box.max));
    }
    if (model.graph.objects.size() > most_objects_counted ||
        instance_count(model.graph) > most_instances_counted)
        return text;
    Graph part = model.graph;
    part.root = id;
    if (const auto count = count_leaves(part, model.components, model.graph.settings.steps))
        text += fmt::format("{} primitive{}. ", *count, *count == "1" ? "" : "s");
    if (model.contraction.verdict == Verdict::proved)
        if (const auto dimension = similarity_dimension(part, model.components))
            text += fmt::format("Dimension {}. ", short_number(*dimension));
    return text;
}

std::string language_of(const Document& document) {
    return document.language() ? std::string(document.language()->extension) : std::string();
}

/// A fence that no line of the text can close: a comment of a model is no Markdown.
std::string fence_around(std::string_view text) {
    std::size_t longest = 0, run = 0;
    for (const char c : text) {
        run = c == '`' ? run + 1 : 0;
        longest = std::max(longest, run);
    }
    return std::string(std::max<std::size_t>(3, longest + 1), '`');
}

/// The lines of a text in a fence; the end of a long one is left out.
std::string fenced(const Document& document, Span span) {
    constexpr std::size_t most = 400;
    std::string_view text = document.text(span);
    const bool cut = text.size() > most;
    std::string shown(text.substr(0, most));
    if (cut)
        shown.resize(
            std::min(shown.size(), shown.rfind('\n') == std::string::npos ? most : shown.rfind('\n')));
    const std::string fence = fence_around(shown);
    return fmt::format("{0}{1}\n{2}{3}\n{0}", fence, language_of(document), shown, cut ? "\n..." : "");
}

/// The line that defines an object: from its first word to its '{'.
Span line_of(const Document& document, Span span) {
    const std::string_view text = document.text();
    const std::size_t begin = span.begin == 0 ? 0 : text.rfind('\n', span.begin - 1) + 1;
    const std::size_t end = std::min(text.find('\n', span.end), text.size());
    return {0, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
}

std::string text_of(const NamedThing& thing, const Document& document, const AnalysedModel* model) {
    std::string text = fmt::format("**{}** `{}`", word_of(thing.kind), thing.name);
    if (thing.whole.known()) {
        const bool line = thing.kind == NameKind::object || thing.kind == NameKind::block ||
                          thing.kind == NameKind::material || thing.kind == NameKind::parameter;
        text += "\n\n" + fenced(document, line ? line_of(document, thing.whole) : thing.whole);
    }
    const bool has_size = thing.kind == NameKind::object || thing.kind == NameKind::block ||
                          thing.kind == NameKind::map || thing.kind == NameKind::model;
    if (!model || !has_size) return text;
    const std::string size = size_of(thing.name, *model);
    return size.empty() ? text : text + "\n\n" + size.substr(0, size.size() - 1);
}

std::string text_of(const Word& word) {
    return fmt::format("`{}`\n\n{}", word.form, word.doc);
}

const Word* meaning(const Place& place, std::string_view text) {
    for (const WordPlace where : place.where)
        if (const Word* word = word_in(where, text)) return word;
    // In a value, a word is a function or a primitive.
    for (const WordPlace where : {WordPlace::value, WordPlace::primitive})
        if (const Word* word = place.string ? nullptr : word_in(where, text)) return word;
    return nullptr;
}

} // namespace

std::optional<Hover> hover(const Document& document, std::uint32_t offset, const AnalysedModel* model) {
    const Place place = place_at(document, offset);
    if (place.where.empty()) return std::nullopt;
    const std::vector<NamedThing> things = names_of(document);
    const NamedThing* const thing = thing_at(things, offset);
    const bool defined = thing && (!thing->definitions.empty() || thing->whole.known());
    Span span = place.word;
    if (defined)
        for (const auto* places : {&thing->definitions, &thing->uses})
            for (const Span at : *places)
                if (at.begin <= offset && offset <= at.end) span = at;
    const std::string_view text = document.text(span);
    const Word* const word = meaning(place, text);
    if (defined) {
        const bool symbol = thing->kind == NameKind::module && word;
        return Hover{span, text_of(*thing, document, model) + (symbol ? "\n\n" + text_of(*word) : "")};
    }
    if (word && !text.empty()) return Hover{span, text_of(*word)};
    if (!thing || thing->kind != NameKind::material) return std::nullopt;
    const auto known = std::ranges::find(named_materials(), thing->name, &Material::name);
    if (known == named_materials().end()) return std::nullopt;
    return Hover{span, fmt::format("**material** `{}`\n\nA material that every model knows.", known->name)};
}

std::optional<FilePlace> definition(const Document& document, std::uint32_t offset) {
    const auto file_of = [&](const std::vector<UseStatement>& uses) -> std::optional<FilePlace> {
        for (const UseStatement& use : uses)
            if (use.path_span.begin <= offset && offset <= use.path_span.end)
                return FilePlace{path_beside(document.name(), use.path), {0, 0, 0}};
        return std::nullopt;
    };
    const std::vector<UseStatement>* const uses = document.lsys()   ? &document.lsys()->uses
                                                  : document.rifs() ? &document.rifs()->uses
                                                  : document.inst() ? &document.inst()->uses
                                                                    : nullptr;
    if (!uses) return std::nullopt;
    if (auto file = file_of(*uses)) return file;
    const std::vector<NamedThing> things = names_of(document);
    const NamedThing* const thing = thing_at(things, offset);
    if (!thing) return std::nullopt;
    if (!thing->definitions.empty()) return FilePlace{document.name(), thing->definitions.front()};
    if (thing->whole.known()) return FilePlace{document.name(), thing->whole};
    return std::nullopt;
}

} // namespace graftal
