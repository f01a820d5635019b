#include "runtime/studio/text_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/chaos/ordinary_ifs.h"
#include "compiler/editing/document.h"
#include "compiler/editing/maps/maps.h"
#include "compiler/support/number.h"
#include "runtime/studio/message_reader.h"

namespace graftal {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_fitted_maps = 16;
constexpr int most_picture_side = 1 << 20; ///< in pixels
constexpr double most_fit_seconds = 60;

struct SentTarget {
    PictureCells picture;
    CellSet cells{0, 0};
};

int side_of(const MessageReader& target, const char* field) {
    const auto side = static_cast<int>(target.needed_whole(field, most_picture_side));
    if (side < 1) throw BadMessage(fmt::format("'{}' is 0: the picture has no pixel", field));
    return side;
}

/// The field `target`: sizes, and the lengths of runs of cells row by row, in turns outside and inside of the
/// set.
SentTarget sent_target(const Json& ask) {
    const Json* const object = MessageReader(ask).object("target");
    if (!object) throw BadMessage("'target' is missing");
    const MessageReader fields(*object);
    SentTarget target;
    target.picture = {side_of(fields, "width"), side_of(fields, "height"), side_of(fields, "cell")};
    const PictureCells& picture = target.picture;
    const auto count = [&](int pixels) { return (pixels - 1) / picture.pixels_per_cell + 1; };
    const int columns = count(picture.width), rows = count(picture.height);
    if (std::max(columns, rows) > most_read_cells_a_side)
        throw BadMessage(fmt::format("the target has {}x{} cells: at most {} lie along a side", columns, rows,
                                     most_read_cells_a_side));
    target.cells = CellSet(columns, rows);
    const auto runs = object->find("runs");
    if (runs == object->end() || !runs->is_array()) throw BadMessage("'runs' is no list of numbers");
    std::size_t at = 0;
    bool inside = false;
    for (const Json& run : *runs) {
        const std::size_t left = target.cells.cells.size() - at;
        if (!run.is_number_unsigned() || run.get<std::uint64_t>() > left)
            throw BadMessage("'runs' are not those of the target's cells");
        const auto length = static_cast<std::ptrdiff_t>(run.get<std::uint64_t>());
        const auto begin = target.cells.cells.begin() + static_cast<std::ptrdiff_t>(at);
        std::fill(begin, begin + length, inside);
        at += static_cast<std::size_t>(length);
        inside = !inside;
    }
    const auto marked =
        static_cast<std::size_t>(std::count(target.cells.cells.begin(), target.cells.cells.end(), true));
    if (marked < least_target_cells)
        throw BadMessage(
            fmt::format("the target has {} dark or opaque pixels, and too few to tell maps by: a "
                        "figure has at least {}, darker than the middle grey, or on a clear "
                        "background",
                        marked, least_target_cells));
    return target;
}

PlaneMap plane_map(const Affine& map) {
    const Mat3& m = map.linear;
    return {m[0][0], m[1][0], m[0][1], m[1][1], map.translation.x, map.translation.y};
}

/// The matrix with the map's numbers in the plane, and its own along z.
Affine with_plane_map(Affine matrix, const PlaneMap& map) {
    matrix.linear[0][0] = map.a;
    matrix.linear[1][0] = map.b;
    matrix.linear[0][1] = map.c;
    matrix.linear[1][1] = map.d;
    matrix.translation.x = map.e;
    matrix.translation.y = map.f;
    return matrix;
}

/// The maps of the text, if they are all of the model's, and may follow each other freely in the plane.
std::vector<EditableMap> fitted_maps(const Document& document, const AskedText& asked) {
    if (!asked.model) throw BadMessage("The text has errors: mend them before you fit its maps.");
    std::vector<EditableMap> maps = maps_of(document, asked.state.stages.lower, asked.model);
    for (const EditableMap& map : maps)
        if (!map.movable) throw BadMessage(fmt::format("'{}' cannot be moved: {}.", map.name, map.why));
    const std::optional<OrdinaryIfs> ifs = ordinary_ifs(asked.model->graph, asked.model->components);
    if (!ifs || !ifs->condensation.empty())
        throw BadMessage(
            "A fit moves the maps of a model in which every map may follow every map: it needs a "
            ".rifs without 'follow' and 'condense'.");
    if (!std::ranges::all_of(ifs->maps, [](const Instance& map) { return is_flat(map.parent_from_child); }))
        throw BadMessage("A fit moves maps of the plane: those of this model leave it.");
    // Each map of the graph is one of the text, so that the text's numbers are all that there is to fit.
    std::vector<Affine> known;
    for (const Instance& map : ifs->maps)
        known.push_back(map.parent_from_child);
    for (const EditableMap& map : maps)
        if (const auto found = std::ranges::find(known, map.matrix); found != known.end()) known.erase(found);
    if (!known.empty() || maps.size() != ifs->maps.size())
        throw BadMessage(
            "The text does not have the maps of this model itself: open the file that has them.");
    if (maps.size() > most_fitted_maps)
        throw BadMessage(
            fmt::format("This model has {} maps: a fit moves {} at most.", maps.size(), most_fitted_maps));
    return maps;
}

/// The maps as the frame has them in cells; those of the attractor of a text.
PlaneMaps maps_in_cells(const std::vector<EditableMap>& maps, const TargetFrame& frame) {
    PlaneMaps cells;
    for (const EditableMap& map : maps)
        cells.push_back(frame.in_cells(plane_map(map.matrix)));
    return cells;
}

[[noreturn]] void refuse_apart(const AskedText& asked, const PictureCells& picture) {
    const auto brief = [](double value) {
        std::string text;
        append_number(text, value, 3);
        return text;
    };
    const Box& box = asked.model->bounds[asked.model->graph.root].box;
    const double height = static_cast<double>(picture.height) / picture.width;
    const Vec3 size = box.size();
    const double factor = std::min(1 / std::max(size.x, 1e-9), height / std::max(size.y, 1e-9));
    throw BadMessage(fmt::format("The model does not meet the target, which lies between <0, 0> and <1, {}>; "
                                 "the model lies between <{}, "
                                 "{}> and <{}, {}>. Drag the boxes of its maps onto the target. To bring all "
                                 "of it to that size, multiply "
                                 "what each map translates by (e and f of a row of codes) by {}.",
                                 brief(height), brief(box.min.x), brief(box.min.y), brief(box.max.x),
                                 brief(box.max.y), brief(factor)));
}

} // namespace

TextFit::TextFit(const Json& ask, const AskedText& asked) : state_(asked.state) {
    if (state_.text->find('\r') != std::string::npos)
        throw BadMessage("lines of the text do not end by line feeds alone");
    const double seconds = MessageReader(ask).number("work").value_or(5);
    if (!(seconds > 0 && seconds <= most_fit_seconds))
        throw BadMessage(fmt::format("'work' is not a number of seconds up to {}", most_fit_seconds));
    const SentTarget sent = sent_target(ask);
    const std::vector<EditableMap> maps = fitted_maps({state_.name, *state_.text}, asked);
    for (const EditableMap& map : maps)
        maps_.push_back({map.name, map.matrix});
    const Crop crop = cropped(sent.cells);
    target_ = std::make_unique<Target>(crop.set);
    frame_ = std::make_unique<TargetFrame>(sent.picture, crop, target_->room());
    fit_ = std::make_unique<MapFit>(*target_, maps_in_cells(maps, *frame_), seconds);
    before_ = fit_->agreement();
    if (before_.tolerant == 0) refuse_apart(asked, sent.picture);
}

bool TextFit::is_about(const StudioState& state) const {
    const LowerOptions &lower = state.stages.lower, &mine = state_.stages.lower;
    return state.text == state_.text && state.name == state_.name && state.files == state_.files &&
           lower.set == mine.set && lower.steps == mine.steps && lower.time == mine.time &&
           lower.seed == mine.seed;
}

Json TextFit::answer(const AskedText& asked) const {
    constexpr double seen = 1.0 / 32; // of a cell
    const Document document(state_.name, *state_.text);
    Hand hand{seen * frame_->scale(), {}};
    if (asked.model) hand.reach = asked.model->bounds[asked.model->graph.root].box;
    std::vector<TextEdit> edits;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
        const Affine wanted = with_plane_map(maps_[i].matrix, frame_->in_model(fit_->maps()[i]));
        const MapChange change = move_map(document, maps_[i].name, wanted, asked.context, hand);
        if (!change.refusal.empty()) throw BadMessage(change.refusal);
        edits.insert(edits.end(), change.edits.begin(), change.edits.end());
    }
    const std::string text = applied(*state_.text, edits);
    const ContractionCheck check = check_contraction(state_.name, text, asked.context);
    if (!check.contracts) throw BadMessage(check.why);
    AttractorPainter painter(*target_);
    painter.draw(maps_in_cells(maps_of({state_.name, text}, state_.stages.lower), *frame_));
    const SetAgreement now = painter.agreement_in_full();
    return {{"edits", edits_json(edits, TextPositions(document.text()))},
            {"before", before_.tolerant},
            {"iou", now.strict},
            {"iou_within_a_cell", now.tolerant},
            {"chamfer_cells", now.chamfer},
            {"work_seconds", fit_->seconds()}};
}

} // namespace graftal
