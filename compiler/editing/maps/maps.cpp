#include "compiler/editing/maps/maps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/editing/maps/least_change.h"
#include "compiler/editing/maps/map_table.h"
#include "compiler/graph/graph.h"
#include "compiler/lower/point_maps.h"
#include "compiler/rifs/system.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

using LineKind = TransformLine::Kind;

/// Read back, a map is what was asked for to within this much of its size; the solution is nearer.
constexpr double read_back = 1e-12;
constexpr double solved = 2e-14;

Box box_of(const AnalysedModel& model, ObjectId id) {
    return id < model.bounds.size() ? model.bounds[id].box : Box();
}

/// The box of the sets that a map maps: of the masters of its object's instances.
Box mapped_box(const WrittenMap& map, const AnalysedModel& model) {
    Box box;
    const auto& objects = model.graph.objects;
    const auto named = [&](const std::string& name) {
        return std::ranges::find(objects, name, &Object::name);
    };
    if (map.group) {
        for (const InstReference& master : map.group->masters)
            if (const auto found = named(master.name); found != objects.end())
                box.include(box_of(model, static_cast<ObjectId>(found - objects.begin())));
        return box;
    }
    const auto found = named(map.object);
    if (found == objects.end()) return box_of(model, model.graph.root);
    for (const Instance& instance : found->instances)
        if (map.form && instance.parent_from_child == map.form->matrix())
            box.include(box_of(model, instance.master));
    return box;
}

// Matrices as residuals

std::vector<double> entries(const Affine& map, bool flat) {
    std::vector<double> list;
    const int size = flat ? 2 : 3;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column)
            list.push_back(map.linear[column][row]);
        list.push_back(map.translation[row]);
    }
    return list;
}

double size_of(const Affine& map) {
    return std::max({largest_entry(map.linear), largest_entry(map.translation), 1e-100});
}

Residual difference_to(const MapForm& form, const Affine& wanted) {
    const bool flat = form.flat();
    const double scale = size_of(wanted);
    return [&form, goal = entries(wanted, flat), flat, scale](const std::vector<double>& numbers) {
        const std::optional<Affine> map = form.at(numbers);
        if (!map) return std::optional<std::vector<double>>();
        std::vector<double> left = entries(*map, flat);
        for (std::size_t i = 0; i < left.size(); ++i)
            left[i] = (left[i] - goal[i]) / scale;
        return std::optional(std::move(left));
    };
}

std::vector<double> units_of(const MapForm& form) {
    std::vector<double> units;
    for (std::size_t i = 0; i < form.values().size(); ++i)
        units.push_back(form.unit(i));
    return units;
}

double change_of(const MapForm& form, const std::vector<double>& numbers) {
    double sum = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double change = (numbers[i] - form.values()[i]) / form.unit(i);
        sum += change * change;
    }
    return sum;
}

/// From the numbers of the text, and from turns of its rotations and mirrored scales, which Newton's method
/// does not cross.
std::vector<std::vector<double>> starts_of(const MapForm& form) {
    std::vector<std::vector<double>> starts = {form.values()};
    std::size_t number = 0;
    for (const TransformLine& line : form.lines()) {
        const bool turns = line.kind == LineKind::rotate, scales = line.kind == LineKind::scale;
        const std::size_t known = starts.size();
        constexpr std::size_t most_starts = 32;
        for (std::size_t i = 0; i < known && starts.size() < most_starts; ++i) {
            if (turns)
                for (const double degrees : {90.0, 180.0, -90.0}) {
                    starts.push_back(starts[i]);
                    starts.back()[number + line.numbers.size() - 1] += degrees;
                }
            if (scales) {
                starts.push_back(starts[i]);
                starts.back()[number] *= -1;
            }
        }
        number += line.numbers.size();
    }
    return starts;
}

/// A turn by so much more than half a circle is one the other way.
void wind_back(const MapForm& form, std::vector<double>& numbers) {
    std::size_t number = 0;
    for (const TransformLine& line : form.lines()) {
        number += line.numbers.size();
        if (line.kind != LineKind::rotate) continue;
        double& degrees = numbers[number - 1];
        const double old = form.values()[number - 1];
        degrees -= 360 * std::round((degrees - old) / 360);
    }
}

std::optional<std::vector<double>> numbers_for(const MapForm& form, const Affine& wanted) {
    if (form.values().empty()) return std::nullopt;
    const Residual residual = difference_to(form, wanted);
    std::optional<std::vector<double>> best;
    for (const std::vector<double>& start : starts_of(form)) {
        auto found = solve_by_least_change(start, units_of(form), residual, solved);
        if (!found) continue;
        wind_back(form, *found);
        if (!best || change_of(form, *found) < change_of(form, *best)) best = std::move(found);
        // The first start changes least, as a rule, and the others cost as much each.
        if (start == form.values()) break;
    }
    return best;
}

// Rows of codes

/// The weights by which a point is the mean of three points of the plane, or four of space.
std::vector<double> barycentric(const std::vector<Vec3>& control, Vec3 point) {
    std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    corners.resize(control.size());
    const Vec3 shares = map_by_points(control, corners).value_or(Affine())(point);
    std::vector<double> weights = {1 - shares.x - shares.y, shares.x, shares.y};
    if (control.size() == 4) {
        weights.front() -= shares.z;
        weights.push_back(shares.z);
    }
    return weights;
}

std::vector<double> codes_of(RifsForm form, const Affine& map, const std::vector<double>& old) {
    const Mat3& m = map.linear;
    const Vec3 t = map.translation;
    if (form == RifsForm::codes_2d) return {m[0][0], m[1][0], m[0][1], m[1][1], t.x, t.y};
    if (form == RifsForm::codes_3d)
        return {m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1],
                m[0][2], m[1][2], m[2][2], t.x,     t.y,     t.z};
    if (form == RifsForm::codes_barycentric) {
        const std::vector<Vec3> control = control_of(old);
        std::vector<double> codes;
        for (const Vec3& point : control) {
            const std::vector<double> weights = barycentric(control, map(point));
            codes.insert(codes.end(), weights.begin(), weights.end());
        }
        codes.insert(codes.end(), old.begin() + static_cast<std::ptrdiff_t>(codes.size()), old.end());
        return codes;
    }
    constexpr double degrees = 57.29577951308232;
    const auto polar = [&](double along, double across, std::size_t length, std::size_t angle) {
        double r = std::hypot(along, across);
        double a = r > 0 ? std::atan2(across, along) * degrees : old[angle];
        if (old[length] < 0) r = -r, a += 180;
        return std::pair(r, a - 360 * std::round((a - old[angle]) / 360));
    };
    const auto [r, theta] = polar(m[0][0], m[0][1], 0, 2);
    const auto [q, phi] = polar(m[1][1], -m[1][0], 1, 3);
    return {r, q, theta, phi, t.x, t.y};
}

// Transform lists

TransformLine line_of(LineKind kind, std::vector<double> values, std::string_view axes = {}) {
    TransformLine line;
    line.kind = kind;
    line.axes = axes;
    for (const double value : values)
        line.numbers.push_back(number_of(value));
    return line;
}

/// A list that can say more than the text's: `scale s` has a number for each axis, and lines are added.
struct Variant {
    bool widens = false;
    std::vector<TransformLine> added;
};

std::vector<Variant> variants_of(const MapForm& form) {
    const bool flat = form.flat();
    const auto has = [&](LineKind kind) {
        return std::ranges::any_of(form.lines(),
                                   [&](const TransformLine& line) { return line.kind == kind; });
    };
    const TransformLine move =
        line_of(LineKind::translate, flat ? std::vector<double>{0, 0} : std::vector<double>{0, 0, 0});
    std::vector<TransformLine> ends;
    if (!has(LineKind::translate)) ends.push_back(move);
    std::vector<TransformLine> turns;
    if (flat)
        turns = {line_of(LineKind::rotate, {0}, "z")};
    else
        turns = {line_of(LineKind::rotate, {0}, "x"), line_of(LineKind::rotate, {0}, "y"),
                 line_of(LineKind::rotate, {0}, "z")};
    if (!has(LineKind::scale))
        turns.insert(turns.begin(), line_of(LineKind::scale,
                                            flat ? std::vector<double>{1, 1} : std::vector<double>{1, 1, 1}));
    turns.push_back(move);
    std::vector<Variant> variants = {{false, {}}, {true, {}}};
    if (!ends.empty()) variants.insert(variants.end(), {{false, ends}, {true, ends}});
    if (form.lines().size() < 12) variants.push_back({true, turns});
    return variants;
}

std::string text_of(const TransformLine& line, bool colon) {
    std::string text(transform_keywords[static_cast<std::size_t>(line.kind)]);
    text += colon ? ": " : " ";
    if (!line.axes.empty()) text += std::string(line.axes) + ", ";
    for (std::size_t i = 0; i < line.numbers.size(); ++i)
        text += (i > 0 ? ", " : "") + number_text(line.numbers[i].number);
    return text;
}

/// Writes a map anew.
class Rewriter {
  public:
    Rewriter(const Document& document, const WrittenMap& map, const Affine& wanted,
             const LowerOptions& options, const Hand& hand)
        : document_(document), map_(map), form_(*map.form), wanted_(wanted), options_(options), hand_(hand) {}

    std::optional<std::vector<TextEdit>> run() {
        if (map_.row && map_.row->form != RifsForm::transforms)
            return written(form_, codes_of(map_.row->form, wanted_, form_.values()),
                           [&](const auto& codes) { return form_.edits(document_, codes); });
        for (const Variant& variant : variants_of(form_))
            if (auto edits = as(variant)) return edits;
        return as_matrix();
    }

  private:
    /// The edits that give the form its numbers, as the hand can tell them.
    template<typename Edits>
    std::optional<std::vector<TextEdit>> written(const MapForm& form, const std::vector<double>& numbers,
                                                 const Edits& edits) const {
        const std::vector<double> rounded = form.rounded(numbers, hand_);
        const std::optional<Affine> map = rounded == numbers ? wanted_ : form.at(rounded);
        return map ? accepted(edits(rounded), *map) : std::nullopt;
    }

    /// The edits, if the text then reads as the matrix.
    std::optional<std::vector<TextEdit>> accepted(std::vector<TextEdit> edits, const Affine& wanted) const {
        const Document after(document_.name(), applied(document_.text(), edits));
        if (after.findings().has_errors()) return std::nullopt;
        for (const WrittenMap& map : written_maps(after, lets_of(after, options_)))
            if (map.name == map_.name && map.form) {
                const std::vector<double> now = entries(map.form->matrix(), form_.flat());
                const std::vector<double> goal = entries(wanted, form_.flat());
                for (std::size_t i = 0; i < now.size(); ++i)
                    if (!(std::abs(now[i] - goal[i]) <= read_back * size_of(wanted))) return std::nullopt;
                return edits;
            }
        return std::nullopt;
    }

    bool colon() const {
        const std::vector<TransformLine>& lines = form_.lines();
        return document_.inst() ? lines.empty() || has_colon(lines.front())
                                : !lines.empty() && has_colon(lines.front());
    }
    bool has_colon(const TransformLine& line) const {
        const std::string_view text = document_.text(line.span);
        const std::size_t keyword = transform_keywords[static_cast<std::size_t>(line.kind)].size();
        const std::size_t next = text.find_first_not_of(' ', keyword);
        return next != std::string_view::npos && text[next] == ':';
    }

    std::optional<std::vector<TextEdit>> as(const Variant& variant) const {
        std::vector<std::size_t> widened;
        std::optional<MapForm> form = variant.widens ? form_.widened(widened) : form_;
        if (variant.widens && widened.empty() && variant.added.empty()) return std::nullopt;
        if (!variant.added.empty()) form = form->with(variant.added);
        if (!form) return std::nullopt;
        const auto numbers = numbers_for(*form, wanted_);
        if (!numbers) return std::nullopt;
        return written(*form, *numbers,
                       [&](const auto& rounded) { return edits_for(*form, rounded, widened); });
    }

    std::vector<TextEdit> edits_for(const MapForm& form, const std::vector<double>& numbers,
                                    const std::vector<std::size_t>& widened) const {
        // The numbers of the lines that the text has, by the forms that they have there.
        std::vector<double> old = form_.values();
        std::vector<TextEdit> edits;
        std::string added;
        std::size_t number = 0, old_number = 0;
        for (std::size_t i = 0; i < form.lines().size(); ++i) {
            TransformLine line = form.lines()[i];
            const std::size_t count = line.numbers.size();
            for (std::size_t k = 0; k < count; ++k)
                line.numbers[k].number = numbers[number + k];
            if (i >= form_.lines().size()) {
                added += "  " + text_of(line, colon());
            } else {
                const TransformLine& text_line = form_.lines()[i];
                if (std::ranges::count(widened, i) > 0) {
                    std::string list;
                    for (std::size_t k = 0; k < count; ++k)
                        list += (k > 0 ? ", " : "") + number_text(numbers[number + k]);
                    replace({0, text_line.numbers.front().span.begin, text_line.numbers.back().span.end},
                            std::move(list), edits);
                } else {
                    for (std::size_t k = 0; k < count; ++k)
                        old[old_number + k] = numbers[number + k];
                }
                old_number += text_line.numbers.size();
            }
            number += count;
        }
        for (TextEdit& edit : form_.edits(document_, old))
            edits.push_back(std::move(edit));
        if (!added.empty()) edits.push_back({map_.list_end.begin, map_.list_end.begin, added});
        return edits;
    }

    /// The text in place of the words of a range, whose comments stay behind it.
    void replace(Span range, std::string text, std::vector<TextEdit>& edits) const {
        Diagnostics ignored;
        std::vector<Span> words; // without a comment between them
        for (const Token& token : lex_range(document_.sources(), range, ignored)) {
            if (token.kind == TokenKind::end) break;
            if (!words.empty() && is_blank(words.back().end, token.span.begin))
                words.back().end = token.span.end;
            else
                words.push_back(token.span);
        }
        for (const Span& span : words)
            edits.push_back({span.begin, span.end, std::exchange(text, {})});
    }

    bool is_blank(std::uint32_t begin, std::uint32_t end) const {
        return document_.text({0, begin, end}).find_first_not_of(" \t\r\f\v\n") == std::string_view::npos;
    }

    /// One line in place of all; what stands between the others stays.
    std::optional<std::vector<TextEdit>> as_matrix() const {
        const Affine map = form_.flat() ? flattened(wanted_) : wanted_;
        std::vector<double> rows;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                rows.push_back(map.linear[column][row]);
            rows.push_back(map.translation[row]);
        }
        const bool projects = is_singular(map);
        const LineKind kind = projects ? LineKind::projection : LineKind::matrix;
        const std::vector<double> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        std::string why;
        const std::optional<MapForm> form = MapForm::of({line_of(kind, projects ? rows : identity)}, {}, why);
        if (!form) return std::nullopt;
        return written(*form, rows, [&](const std::vector<double>& rounded) {
            const std::string text = text_of(line_of(kind, rounded), colon());
            std::vector<TextEdit> edits;
            for (const TransformLine& line : form_.lines())
                replace(line.span, edits.empty() ? text : "", edits);
            if (edits.empty()) edits.push_back({map_.list_end.begin, map_.list_end.begin, "  " + text});
            return edits;
        });
    }

    const Document& document_;
    const WrittenMap& map_;
    const MapForm& form_;
    Affine wanted_;
    const LowerOptions& options_;
    const Hand hand_;
};

/// The rules that a matrix breaks for this map, or "".
std::string fault_of(const WrittenMap& map, const Affine& wanted) {
    if (!is_finite(wanted)) return "The matrix has entries that are no numbers.";
    const Mat3& m = wanted.linear;
    const double out = std::max({std::abs(m[0][2]), std::abs(m[1][2]), std::abs(m[2][0]), std::abs(m[2][1]),
                                 std::abs(wanted.translation.z)});
    const bool row = map.row && map.row->form != RifsForm::transforms;
    if (row && map.row->form != RifsForm::codes_3d && map.form->flat() && out > read_back * size_of(wanted))
        return "A row of codes of the plane moves in the plane only.";
    return {};
}

/// A flat map that leaves the plane is one of space.
bool leaves_plane(const Affine& wanted) {
    const Mat3& m = wanted.linear;
    return m[0][2] != 0 || m[1][2] != 0 || m[2][0] != 0 || m[2][1] != 0 || wanted.translation.z != 0;
}

} // namespace

std::vector<EditableMap> maps_of(const Document& document, const LowerOptions& options,
                                 const AnalysedModel* model) {
    std::vector<EditableMap> maps;
    for (const WrittenMap& written : written_maps(document, lets_of(document, options))) {
        EditableMap map;
        map.name = written.name;
        map.object = written.object;
        map.span = written.span;
        map.movable = written.form.has_value();
        map.why = written.why;
        if (written.form) {
            map.matrix = written.form->matrix();
            map.contraction = norm(map.matrix.linear);
        }
        if (model) map.box = mapped_box(written, *model);
        maps.push_back(std::move(map));
    }
    return maps;
}

MapChange move_map(const Document& document, std::string_view name, const Affine& matrix,
                   const EditContext& context, const Hand& hand) {
    const std::vector<WrittenMap> maps = written_maps(document, lets_of(document, context.lower));
    const auto found = std::ranges::find(maps, name, &WrittenMap::name);
    if (found == maps.end()) return {{}, fmt::format("There is no map '{}'.", name)};
    if (!found->form) return {{}, fmt::format("'{}' cannot be moved: {}.", name, found->why)};
    if (std::string fault = fault_of(*found, matrix); !fault.empty()) return {{}, std::move(fault)};
    WrittenMap map = *found;
    if (map.form->flat() && leaves_plane(matrix)) map.form = map.form->in_space();
    const Affine wanted = map.form->flat() ? flattened(matrix) : matrix;
    const std::optional<std::vector<TextEdit>> edits =
        Rewriter(document, map, wanted, context.lower, hand).run();
    if (!edits)
        return {{}, fmt::format("'{}' cannot have this matrix: it is too large, too small or flat.", name)};
    MapChange change{*edits};
    change.ratio = norm(wanted.linear);
    const ContractionCheck check =
        check_contraction(document.name(), applied(document.text(), *edits), context);
    change.contracts = check.contracts;
    change.why = check.why;
    return change;
}

} // namespace graftal
