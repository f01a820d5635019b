// The text of an unfolding.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/unfolding.h"

namespace graftal::cfdg {

namespace {

constexpr std::size_t longest_unfolding = 48'000'000;
/// Most colour steps of a recursive instance that is written within the only object that holds it.
constexpr std::size_t most_steps_held = 64;

} // namespace

const std::string& Unfolding::name_of(std::size_t id) {
    Node& node = nodes_[id];
    if (!node.name.empty()) return node.name;
    const std::string& shape = node.value.name;
    const std::size_t number = ++named_[node.shape];
    return node.name = free_name(number == 1 ? shape : fmt::format("{}_{}", shape, number));
}
/// Whether a line draws a shape of rules, which is painted when its turn comes.
bool Unfolding::is_call(const Line& line) const {
    return line.master.empty() && !nodes_[line.node].part &&
           !grammar_.shapes[nodes_[line.node].shape].is_path;
}

void Unfolding::find_order(std::size_t first) {
    instances_.assign(nodes_.size(), 0);
    std::vector<std::vector<PaintedLine>> objects(nodes_.size());
    for (std::size_t id = 0; id < nodes_.size(); ++id) {
        const double depth = nodes_[id].world.linear[2][2];
        for (const Line& line : nodes_[id].lines) {
            PaintedLine& painted = objects[id].emplace_back();
            painted.depth = depth * line.map.translation.z;
            painted.beside = line.beside;
            if (!line.master.empty() || !is_drawn(line)) continue; // too small to be seen
            painted.node = line.node;
            painted.is_call = is_call(line);
            painted.is_part = nodes_[line.node].part;
            if (painted.is_call) painted.log_shrunk = -std::log(size_of(line.map));
            ++instances_[line.node];
        }
    }
    const double extent = extent_ > 0 ? extent_ : 1;
    order_.emplace(objects, first, extent, translucent_ ? copies_.size() : 0, endless_);
    copy_step_ = order_->gap();
    camera_height_ = extent + 2 * order_->top();
}

void Unfolding::write_nodes(std::size_t first) {
    std::vector<bool> written(nodes_.size());
    std::vector<std::size_t> needed = {first};
    for (std::size_t next = 0; next < needed.size(); ++next) {
        const std::size_t id = needed[next];
        if (written[id]) continue;
        written[id] = true;
        const Span place = grammar_.shapes[nodes_[id].shape].span;
        write_node(id, needed);
        if (out_.text.size() > longest_unfolding) return fail(place, "the grammar makes too many objects");
    }
}

void Unfolding::write_node(std::size_t id, std::vector<std::size_t>& needed) {
    const Shape& shape = grammar_.shapes[nodes_[id].shape];
    line("");
    if (commented_.insert(nodes_[id].shape).second)
        for (const std::string& words : shape.comments)
            comment(words);
    line(fmt::format("canonical object {} {{", name_of(id)), shape.span);
    ++depth_;
    const std::size_t before = out_.text.size();
    std::vector<Written> open; // the next one last
    const auto add_lines = [&](std::size_t of, const Affine& map, const std::vector<ColourStep>& colours) {
        const std::vector<Line>& lines = nodes_[of].lines;
        for (std::size_t i = lines.size(); i-- > 0;) {
            if (!is_drawn(lines[i])) continue;
            Affine own = lines[i].map;
            own.linear[2] = {0, 0, endless_ && is_call(lines[i]) ? size_of(own) : 1};
            own.translation.z = order_->height(of, i);
            std::vector<ColourStep> all = colours;
            all.insert(all.end(), lines[i].colours.begin(), lines[i].colours.end());
            open.push_back({&lines[i], of, map * own, shortened(all)});
        }
    };
    add_lines(id, {}, {});
    while (!open.empty() && out_.text.size() <= longest_unfolding) {
        const Written one = std::move(open.back());
        open.pop_back();
        if (is_held(one))
            add_lines(one.line->node, one.map, one.colours);
        else
            write_line(id, one, needed);
    }
    if (out_.text.size() == before) line("nothing");
    --depth_;
    line("}");
}

/// Whether a line stands for the lines of its node, which nothing else draws: long recursion then makes no
/// long chain of objects.
bool Unfolding::is_held(const Written& one) const {
    return one.line->master.empty() && instances_[one.line->node] == 1 &&
           recursion_.recurs(nodes_[one.line->node].shape) && !endless_ &&
           one.colours.size() <= most_steps_held;
}

void Unfolding::write_line(std::size_t id, const Written& one, std::vector<std::size_t>& needed) {
    Affine map = one.map;
    if (one.line->fills) map.linear = Mat3(1e4 * std::max(extent_, 1e-3) / size_of(nodes_[id].world));
    const std::string& master = one.line->master.empty() ? name_of(one.line->node) : one.line->master;
    Target target = nodes_[id].target;
    const std::optional<std::string> inks = ink_text(one.colours, target);
    line(fmt::format("{}{}{}{}", master.starts_with("instance:") ? "" : "instance: ", master, moves_text(map),
                     inks.value_or("")),
         one.line->span);
    if (one.line->master.empty()) needed.push_back(one.line->node);
}

} // namespace graftal::cfdg
