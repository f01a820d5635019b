#include "compiler/lower/lower_pattern.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/graph/pattern_colours.h"

namespace graftal {

namespace {

bool find_kind(const SceneField& field, Diagnostics& diagnostics, PatternKind& kind) {
    const auto words = pattern_words();
    const auto found = std::ranges::find(words, field.name);
    if (found == words.end()) {
        diagnostics.error(field.name_span, fmt::format("there is no pattern '{}'", field.name))
            .with_hint(choices(field.name, {words.begin(), words.end()}));
        return false;
    }
    kind = static_cast<PatternKind>(found - words.begin());
    return true;
}

class LayerReader {
  public:
    LayerReader(const SceneFields& fields, std::size_t number, Diagnostics& diagnostics)
        : fields_(fields), number_(number), diagnostics_(diagnostics) {}

    void read(PatternLayer& layer) const {
        layer.scale = fields_.size(name("scale")).value_or(layer.scale);
        layer.octaves = fields_.whole(name("octaves"), 1, SolidPattern::most_octaves).value_or(layer.octaves);
        layer.warp = fields_.within(name("warp"), 0, 4).value_or(layer.warp);
        if (const SceneField* stretch = fields_.find(name("stretch"))) {
            const auto factors = lower_vector(stretch->values, fields_.lets(), diagnostics_);
            const auto good = between(1e-3, 1e3);
            if (factors && good(factors->x) && good(factors->y) && good(factors->z))
                layer.stretch = *factors;
            else if (factors)
                fields_.error(stretch->keyword, "each factor of 'stretch' must lie between 0.001 and 1000");
        }
        const SceneField* const space = fields_.find(name("space"));
        if (!space) return;
        layer.of_world = space->name == "world";
        if (!layer.of_world && space->name != "part")
            diagnostics_.error(space->name_span, fmt::format("there is no space '{}'", space->name))
                .with_hint("write 'part', whose size the scale is a share of, or 'world'");
    }

    double share() const {
        const auto good = [](double x) { return x > 0 && x < 1; };
        return fields_.number(name("share"), good, "be above 0 and below 1").value_or(0.5);
    }

  private:
    std::string name(std::string_view keyword) const { return layer_field(keyword, number_); }

    const SceneFields& fields_;
    std::size_t number_;
    Diagnostics& diagnostics_;
};

/// Reads what `plus` adds.
void add_layers(const SceneFields& fields, Diagnostics& diagnostics, SolidPattern& pattern) {
    for (std::size_t number = 1;; ++number) {
        const SceneField* const plus = fields.find(layer_field("plus", number));
        PatternKind kind{};
        if (!plus || !find_kind(*plus, diagnostics, kind)) return;
        if (pattern.layers.size() == SolidPattern::most_layers) {
            diagnostics
                .error(plus->span, fmt::format("a pattern has at most {} layers", SolidPattern::most_layers))
                .with_hint("leave out a 'plus'");
            return;
        }
        const LayerReader reader(fields, number, diagnostics);
        PatternLayer layer{.kind = kind, .share = reader.share()};
        reader.read(layer);
        pattern.layers.push_back(layer);
    }
}

/// Fields that mean nothing without a pattern are errors.
void refuse_fields(const SceneFields& fields) {
    for (const char* const name :
         {"scale", "octaves", "stretch", "warp", "space", "share", "low", "high", "bump", "plus 1"})
        if (const SceneField* const field = fields.find(name)) {
            const std::string word = field->keyword.substr(0, field->keyword.find(' '));
            return fields.error(name, fmt::format("'{}' belongs to a pattern, and this material has none: "
                                                  "begin with 'pattern: noise'",
                                                  word));
        }
}

} // namespace

void lower_pattern(const SceneFields& fields, Diagnostics& diagnostics, Material& material) {
    SolidPattern& pattern = material.pattern;
    const SceneField* const word = fields.find("pattern");
    if (word && word->name != "none" && fields.flag("texture"))
        return fields.error("pattern", "a material has a picture or a pattern; leave out one of the two");
    if (fields.flag("texture") || (word && word->name == "none")) pattern = {};
    if (word && word->name != "none") {
        PatternKind kind{};
        if (!find_kind(*word, diagnostics, kind)) return;
        pattern.layers = {{.kind = kind}};
        material.texture.clear();
        material.coverage = 1;
    }
    if (!pattern) return refuse_fields(fields);
    LayerReader(fields, 0, diagnostics).read(pattern.layers.front());
    if (fields.flag("share"))
        fields.error("share", "'share' is that of a pattern on another one: put it after a 'plus'");
    add_layers(fields, diagnostics, pattern);
    if (word || fields.flag("color")) take_own_colours(material);
    pattern.low = fields.color("low").value_or(pattern.low);
    pattern.high = fields.color("high").value_or(pattern.high);
    pattern.bump = fields.within("bump", -10, 10).value_or(pattern.bump);
}

} // namespace graftal
