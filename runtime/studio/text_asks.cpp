#include "runtime/studio/text_asks.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "compiler/editing/complete.h"
#include "compiler/editing/document.h"
#include "compiler/editing/drag.h"
#include "compiler/editing/format.h"
#include "compiler/editing/hover.h"
#include "compiler/editing/maps/maps.h"
#include "compiler/editing/rename.h"
#include "compiler/editing/setting.h"
#include "compiler/editing/vary.h"
#include "runtime/studio/message_reader.h"
#include "runtime/studio/model_message.h"

namespace graftal {

namespace {

using Json = nlohmann::json;

/// One ask. Its document and positions are those of the state's text.
class TextAsk {
  public:
    TextAsk(const Json& ask, const AskedText& asked)
        : fields_(ask), ask_(ask), asked_(asked), document_(asked.state.name, *asked.state.text),
          positions_(document_.text()) {}

    Json answer(const std::string& what) {
        if (what == "complete") return completions();
        if (what == "hover") return hovered();
        if (what == "definition") return defined();
        if (what == "rename") return renamed();
        if (what == "format") return {{"edits", edits_json(format(document_))}};
        if (what == "map")
            return change_json(
                move_map(document_, fields_.needed_text("name"), matrix(), asked_.context, hand()));
        if (what == "pull") return pulled();
        if (what == "drag") return part_dragged();
        if (what == "digraph") return toggled();
        if (what == "setting") return set();
        return varied();
    }

  private:
    std::uint32_t offset() const {
        return positions_.byte_of(static_cast<std::uint32_t>(fields_.needed_whole("offset", UINT32_MAX)));
    }

    Json with_place(Json json, const Span& span) const {
        json["from"] = positions_.utf16_of(span.begin);
        json["to"] = positions_.utf16_of(span.end);
        return json;
    }

    Json edits_json(const std::vector<TextEdit>& edits) const {
        return graftal::edits_json(edits, positions_);
    }

    Json change_json(const MapChange& change) const {
        if (!change.refusal.empty()) throw BadMessage(change.refusal);
        return {{"edits", edits_json(change.edits)},
                {"ratio", change.ratio},
                {"contracts", change.contracts},
                {"why", change.why}};
    }

    Json completions() const {
        const Completions found = complete(document_, offset());
        Json items = Json::array();
        for (const Completion& item : found.items)
            items.push_back(
                {{"label", item.label}, {"kind", item.kind}, {"detail", item.detail}, {"text", item.text}});
        return {{"from", positions_.utf16_of(found.from)}, {"items", std::move(items)}};
    }

    Json hovered() const {
        const std::optional<Hover> found = hover(document_, offset(), asked_.model);
        return found ? with_place({{"text", found->text}}, found->span) : Json::object();
    }

    Json defined() const {
        const std::optional<FilePlace> found = definition(document_, offset());
        if (!found) return Json::object();
        if (found->file == document_.name()) return with_place({{"file", found->file}}, found->span);
        return {{"file", found->file}, {"from", 0}, {"to", 0}};
    }

    Json renamed() const {
        const Renaming result = rename(document_, offset(), fields_.needed_text("name"));
        if (!result.refusal.empty()) throw BadMessage(result.refusal);
        return {{"edits", edits_json(result.edits)}};
    }

    Affine matrix() const {
        constexpr std::size_t rows = 3, columns = 4;
        const auto found = ask_.find("matrix");
        if (found == ask_.end() || !found->is_array() || found->size() != rows * columns)
            throw BadMessage("'matrix' is not a list of 12 numbers");
        Affine map;
        for (std::size_t i = 0; i < rows * columns; ++i) {
            const Json& number = (*found)[i];
            if (!number.is_number()) throw BadMessage("'matrix' is not a list of 12 numbers");
            const auto row = static_cast<int>(i / columns), column = static_cast<int>(i % columns);
            (column == 3 ? map.translation[row] : map.linear[column][row]) = number.get<double>();
        }
        return map;
    }

    Json pulled() const {
        const std::optional<Vec3> from = fields_.vector("from"), to = fields_.vector("to");
        if (!from || !to) throw BadMessage("'from' or 'to' is missing");
        return change_json(
            pull(document_, fields_.needed_text("address"), *from, *to, asked_.context, hand()));
    }

    Hand hand() const {
        Hand hand{std::max(0.0, fields_.number("grain").value_or(0)), {}};
        if (asked_.model) hand.reach = asked_.model->bounds[asked_.model->graph.root].box;
        return hand;
    }

    Json part_dragged() const {
        const std::optional<Vec3> from = fields_.vector("from"), to = fields_.vector("to");
        if (!from || !to) throw BadMessage("'from' or 'to' is missing");
        DraggedPart part{instances(), *from, *to, {}, hand().grain};
        if (const auto number = fields_.whole("number", UINT32_MAX))
            part.number = positions_.byte_of(static_cast<std::uint32_t>(*number));
        const DragChange change = drag_part(document_, part, asked_.context);
        if (!change.refusal.empty()) throw BadMessage(change.refusal);
        return {{"edits", edits_json(change.edits)},
                {"number", positions_.utf16_of(change.number)},
                {"point", vector_json(change.point)}};
    }

    std::vector<std::uint32_t> instances() const {
        std::vector<std::uint32_t> numbers;
        const auto found = ask_.find("part");
        if (found == ask_.end() || !found->is_array()) throw BadMessage("'part' is no list of numbers");
        for (const Json& number : *found) {
            if (!number.is_number_unsigned() || number.get<std::uint64_t>() > UINT32_MAX)
                throw BadMessage("'part' is no list of numbers");
            numbers.push_back(number.get<std::uint32_t>());
        }
        return numbers;
    }

    Json toggled() const {
        const std::optional<bool> edge = fields_.flag("edge");
        if (!edge) throw BadMessage("'edge' is missing");
        return change_json(set_edge(document_, fields_.needed_text("from"), fields_.needed_text("to"), *edge,
                                    asked_.context));
    }

    Json set() const {
        constexpr std::uint64_t most = std::uint64_t{1} << 53u;
        const std::string name = fields_.needed_text("name");
        if (name != "steps" && name != "seed") throw BadMessage("'name' is neither steps nor seed");
        const SettingChange change =
            write_setting(document_, name == "steps" ? ModelSetting::steps : ModelSetting::seed,
                          fields_.needed_whole("value", most));
        if (!change.refusal.empty()) throw BadMessage(change.refusal);
        return {{"edits", edits_json(change.edits)}, {"why", change.remark}};
    }

    VariationKind kind() const {
        const std::string name = fields_.needed_text("kind");
        if (name == "seed") return VariationKind::seed;
        if (name == "parameters") return VariationKind::parameters;
        if (name == "rules") return VariationKind::rules;
        throw BadMessage("'kind' is none of seed, parameters, rules");
    }

    Json varied() const {
        constexpr std::uint64_t most_children = 100;
        VariationOptions options;
        options.kind = kind();
        options.count = fields_.whole("count", most_children).value_or(options.count);
        options.spread = std::clamp(fields_.number("spread").value_or(options.spread), 0.0, 1.0);
        options.seed = fields_.whole("seed", UINT64_MAX).value_or(0);
        const std::vector<ModelParameter> unknown;
        Json children = Json::array();
        for (const Variation& child :
             vary(document_, asked_.parameters ? *asked_.parameters : unknown, options, asked_.context)) {
            Json json{{"says", child.says}};
            if (child.text) json["text"] = *child.text;
            if (child.seed) json["seed"] = *child.seed;
            if (!child.set.empty()) {
                json["set"] = Json::object();
                for (const auto& [name, value] : child.set)
                    json["set"][name] = value;
            }
            children.push_back(std::move(json));
        }
        return {{"children", std::move(children)}};
    }

    const MessageReader fields_;
    const Json& ask_;
    const AskedText& asked_;
    const Document document_;
    const TextPositions positions_;
};

Json matrix_json(const Affine& map) {
    Json numbers = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            numbers.push_back(column == 3 ? map.translation[row] : map.linear[column][row]);
    return numbers;
}

} // namespace

bool is_about_text(const std::string& what) {
    constexpr std::string_view known[] = {"complete", "hover", "definition", "rename", "format", "map",
                                          "pull",     "drag",  "digraph",    "vary",   "setting"};
    return std::ranges::find(known, what) != std::end(known);
}

Json answer_about_text(const std::string& what, const Json& ask, const AskedText& asked) {
    if (asked.state.text->find('\r') != std::string::npos)
        throw BadMessage("lines of the text do not end by line feeds alone");
    return TextAsk(ask, asked).answer(what);
}

Json edits_json(const std::vector<TextEdit>& edits, const TextPositions& positions) {
    Json list = Json::array();
    for (const TextEdit& edit : edits)
        list.push_back({{"text", edit.text},
                        {"from", positions.utf16_of(edit.begin)},
                        {"to", positions.utf16_of(edit.end)}});
    return list;
}

void add_maps(Json& message, const StudioState& state, const AnalysedModel& model) {
    Json &maps = message["maps"] = Json::array(), &digraphs = message["digraphs"] = Json::array();
    if (state.text->find('\r') != std::string::npos) return;
    const Document document(state.name, *state.text);
    const TextPositions positions(document.text());
    for (const EditableMap& map : maps_of(document, state.stages.lower, &model)) {
        Json json{{"name", map.name},
                  {"object", map.object},
                  {"matrix", matrix_json(map.matrix)},
                  {"box", box_json(map.box)},
                  {"contraction", map.contraction},
                  {"from", positions.utf16_of(map.span.begin)},
                  {"to", positions.utf16_of(map.span.end)},
                  {"movable", map.movable}};
        if (!map.movable) json["why"] = map.why;
        maps.push_back(std::move(json));
    }
    for (const Digraph& digraph : digraphs_of(document))
        digraphs.push_back({{"block", digraph.block}, {"maps", digraph.maps}, {"edges", digraph.edges}});
}

} // namespace graftal
