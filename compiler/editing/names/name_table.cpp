#include "compiler/editing/names/name_table.h"

#include <algorithm>

namespace graftal {

namespace {

NameSpace space_of(NameKind kind) {
    switch (kind) {
    case NameKind::let:
    case NameKind::inner:
    case NameKind::parameter:
    case NameKind::variable:
    case NameKind::local:
        return NameSpace::value;
    case NameKind::table:
    case NameKind::function:
        return NameSpace::function;
    case NameKind::module:
        return NameSpace::module;
    case NameKind::label:
        return NameSpace::label;
    case NameKind::material:
        return NameSpace::material;
    case NameKind::map:
        return NameSpace::map;
    case NameKind::block:
    case NameKind::object:
    case NameKind::model:
        return NameSpace::object;
    }
    return NameSpace::value;
}

NameKind kind_in(NameSpace space) {
    constexpr NameKind kinds[] = {NameKind::let,      NameKind::function, NameKind::module, NameKind::label,
                                  NameKind::material, NameKind::map,      NameKind::object};
    return kinds[static_cast<std::size_t>(space)];
}

} // namespace

void NameTable::define(NameScope& scope, NameKind kind, Name name, Span whole) {
    const auto [place, fresh] =
        scope.things.try_emplace({space_of(kind), std::string(name.text)}, things_.size());
    if (fresh)
        things_.push_back(
            {kind, std::string(name.text), scope.span, {}, {}, whole.known() ? whole : name.span});
    things_[place->second].definitions.push_back(name.span);
}

void NameTable::define_nameless(NameScope& scope, NameKind kind, std::string name, Span whole) {
    scope.things.try_emplace({space_of(kind), name}, things_.size());
    things_.push_back({kind, std::move(name), scope.span, {}, {}, whole});
}

void NameTable::use(const NameScope& scope, NameSpace space, std::string_view name, Span span) {
    const std::pair<NameSpace, std::string> key{space, name};
    for (const NameScope* at = &scope; at; at = at->outer)
        if (const auto found = at->things.find(key); found != at->things.end()) {
            things_[found->second].uses.push_back(span);
            return;
        }
    free_[key].push_back(span);
}

bool NameTable::is_variable(const NameScope& scope, std::string_view name) const {
    const auto found = scope.things.find(std::pair{NameSpace::value, std::string(name)});
    return found != scope.things.end() && things_[found->second].kind == NameKind::variable;
}

/// Places each once and in order: groups share repeats, and values of `with` are written out.
std::vector<NamedThing> NameTable::settled() && {
    const auto tidy = [](std::vector<Span>& spans) {
        std::ranges::sort(spans, {}, &Span::begin);
        spans.erase(std::unique(spans.begin(), spans.end()), spans.end());
    };
    const auto first_place = [](const NamedThing& thing) {
        const std::uint32_t used = thing.uses.empty() ? UINT32_MAX : thing.uses.front().begin;
        return std::min(used,
                        thing.definitions.empty() ? thing.whole.begin : thing.definitions.front().begin);
    };
    for (NamedThing& thing : things_) {
        std::vector<Span>& places = thing.definitions;
        const Span first = places.empty() ? Span() : places.front();
        tidy(places);
        std::erase_if(thing.uses, [&](Span use) {
            return std::ranges::binary_search(places, use.begin, {}, &Span::begin);
        });
        // The first production stays in front of the list of modules.
        if (const auto at = std::ranges::find(places, first); at != places.end())
            std::rotate(places.begin(), at, at + 1);
        tidy(thing.uses);
    }
    std::ranges::stable_sort(things_, {}, first_place);
    for (auto& [key, uses] : free_) {
        tidy(uses);
        things_.push_back({kind_in(key.first), key.second, {}, {}, std::move(uses), {}});
    }
    return std::move(things_);
}

} // namespace graftal
