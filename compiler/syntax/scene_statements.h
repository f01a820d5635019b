#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/expression.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// `keyword: values` in a scene statement, unevaluated.
struct SceneField {
    std::string keyword;
    Span span;                      ///< of the keyword
    std::vector<Expression> values; ///< none of a flag, one of a number, three of a vector or colour
    std::string name; ///< where the value is a name (`material: bark`) or a string, or "disc" of an area
    Span name_span;
};

/// camera, light, sky, haze, film, background, ground, material, steps, let, inner or preset. Short forms are
/// spelled out: `steps: 5` has the field "steps", `background: r,g,b` the field "zenith", and `let a = 1, b =
/// 2` one field a name. `inner k = 0.5 members 16` is a `let` with a second value. `preset oak { angle = 30
/// }` has a field for each name that it sets.
struct SceneStatement {
    enum class Kind : std::uint8_t {
        camera,
        light,
        background,
        ground,
        material,
        steps,
        let,
        inner,
        sky,
        film,
        haze,
        preset
    };

    Kind kind = Kind::camera;
    std::string name; ///< of a material or preset
    Span span;        ///< of the keyword, or of that name
    std::vector<SceneField> fields;
    bool complete = true; ///< false if an error lost a part of it
};

/// The keyword of a field of a material's layer, such as "scale 2": those after the second `plus` belong to
/// the layer 2.
std::string layer_field(std::string_view keyword, std::size_t layer);

/// The words that begin scene statements, for suggestions.
const std::vector<std::string>& scene_keywords();

/// The keywords of the fields that a statement of this kind may have in its braces.
std::vector<std::string_view> scene_fields(SceneStatement::Kind kind);

/// True if the next tokens begin a scene statement.
bool at_scene_statement(const TokenStream& stream);

/// Requires at_scene_statement(). Parses the statement into `statements`; errors are reported, and the
/// stream then stands where parsing can go on. A `let` or `inner` in error has the value 1, so that its uses
/// are known.
void parse_scene_statement(TokenStream& stream, std::vector<SceneStatement>& statements);

} // namespace graftal
