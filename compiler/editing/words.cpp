#include "compiler/editing/words.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

#include "compiler/inst/parse/parser.h"
#include "compiler/inst/parse/repeat.h"
#include "compiler/lsys/parse/parser.h"
#include "compiler/lsys/parse/scanner.h"
#include "compiler/lsys/parse/surroundings.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/rifs/orbit_parser.h"
#include "compiler/rifs/parser.h"
#include "compiler/rifs/parts.h"
#include "compiler/syntax/expression_functions.h"
#include "compiler/syntax/scene_statements.h"
#include "compiler/syntax/transform.h"

namespace graftal {

namespace {

using Words = std::vector<std::string_view>;

template<typename List> void add(Words& words, const List& list) {
    words.insert(words.end(), std::begin(list), std::end(list));
}

Words file_words(std::span<const std::string_view> own) {
    Words words(own.begin(), own.end());
    add(words, scene_keywords());
    return words;
}

Words rifs_words(std::span<const std::string_view> own) {
    Words words(transform_keywords.begin(), transform_keywords.end());
    add(words, own);
    return words;
}

Words value_words() {
    Words words{"pi"};
    for (const ExpressionFunction& function : expression_functions())
        words.emplace_back(function.name);
    for (const ExpressionFunction& function : chance_functions())
        words.emplace_back(function.name);
    return words;
}

std::optional<SceneStatement::Kind> statement_of(WordPlace place) {
    using Kind = SceneStatement::Kind;
    switch (place) {
    case WordPlace::camera:
        return Kind::camera;
    case WordPlace::light:
        return Kind::light;
    case WordPlace::background:
        return Kind::background;
    case WordPlace::ground:
        return Kind::ground;
    case WordPlace::material:
        return Kind::material;
    case WordPlace::sky:
        return Kind::sky;
    case WordPlace::film:
        return Kind::film;
    case WordPlace::haze:
        return Kind::haze;
    default:
        return std::nullopt;
    }
}

} // namespace

std::vector<std::string_view> words_in(WordPlace place) {
    if (const auto statement = statement_of(place)) return scene_fields(*statement);
    Words words;
    switch (place) {
    case WordPlace::lsys_file:
        return file_words(lsys_file_keywords);
    case WordPlace::rifs_file:
        return file_words(rifs_keywords);
    case WordPlace::inst_file:
        return file_words(inst_keywords);
    case WordPlace::lsys_block:
        add(words, lsys_keywords());
        return words;
    case WordPlace::rifs_block:
        add(words, rifs_item_words);
        words.emplace_back("inner");
        return words;
    case WordPlace::rifs_map:
        return rifs_words(rifs_map_words);
    case WordPlace::rifs_part: {
        static constexpr std::array<std::string_view, 4> own = {"tint", "material", "probability", "below"};
        return rifs_words(own);
    }
    case WordPlace::orbit:
        add(words, orbit_words);
        return words;
    case WordPlace::inst_body:
        add(words, body_keywords());
        add(words, Words{"repeat", "when", "else", "nothing"});
        return words;
    case WordPlace::ink:
        return {"hue", "saturation", "value", "alpha"};
    case WordPlace::value:
        return value_words();
    case WordPlace::turtle:
        for (const TurtleSymbol& symbol : turtle_symbols)
            words.push_back(symbol.text);
        return words;
    case WordPlace::primitive:
        for (const PrimitiveKind kind : all_primitive_kinds)
            words.push_back(name_of(kind));
        return words;
    case WordPlace::environment:
        return environment_kinds();
    default:
        return words;
    }
}

std::vector<WordPlace> all_word_places() {
    std::vector<WordPlace> places;
    for (int place = 0; place <= static_cast<int>(WordPlace::environment); ++place)
        places.push_back(static_cast<WordPlace>(place));
    return places;
}

} // namespace graftal
