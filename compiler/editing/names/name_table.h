#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/editing/names/names.h"

namespace graftal {

/// Kinds of names that are told apart by their places: a map and a `let` may have one name.
enum class NameSpace : std::uint8_t { value, function, module, label, material, map, object };

/// A part of the text in which names are known, in a chain up to the whole text.
struct NameScope {
    const NameScope* outer = nullptr;
    Span span;
    std::map<std::pair<NameSpace, std::string>, std::size_t, std::less<>> things = {};
};

/// The names that a walk over a text meets.
class NameTable {
  public:
    /// `whole`: the text that defines the name, if it is more than the name itself.
    void define(NameScope& scope, NameKind kind, Name name, Span whole = {});
    /// Adds a thing whose name the text does not say where it defines the thing.
    void define_nameless(NameScope& scope, NameKind kind, std::string name, Span whole);

    /// A name is that of the nearest scope that knows it; else it is free.
    void use(const NameScope& scope, NameSpace space, std::string_view name, Span span);
    void use(const NameScope& scope, NameSpace space, Name name) { use(scope, space, name.text, name.span); }

    /// Whether a scope, without those around it, knows the name as a variable.
    bool is_variable(const NameScope& scope, std::string_view name) const;

    /// All of them, as names_of() gives them.
    std::vector<NamedThing> settled() &&;

  private:
    std::vector<NamedThing> things_;
    std::map<std::pair<NameSpace, std::string>, std::vector<Span>> free_;
};

} // namespace graftal
