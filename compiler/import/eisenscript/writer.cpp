#include "compiler/import/eisenscript/writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/eisenscript/text.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/own_words.h"
#include "compiler/support/number.h"

namespace graftal::eisenscript {

namespace {

/// Copies that are written one by one, in the whole script.
constexpr std::size_t most_written_copies = 10'000;
/// Operators of such copies, and colours of pools, in the whole script.
constexpr std::size_t most_written_words = 300'000;
bool is_identifier(std::string_view name) {
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) return false;
    return std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

bool has_colours(const std::vector<Operator>& operators) {
    return std::ranges::any_of(operators, [](const Operator& op) { return !op.moves(); });
}

bool commute(const Affine& a, const Affine& b) {
    const Affine ab = a * b, ba = b * a;
    const double size = 1 + largest_entry(ab.linear) + largest_entry(ab.translation);
    return largest_entry(ab.linear - ba.linear) <= 1e-12 * size &&
           largest_entry(ab.translation - ba.translation) <= 1e-12 * size;
}

int copies_of(const Loop& loop) {
    return std::max(1, static_cast<int>(loop.count.number));
}

} // namespace

Writer::Writer(const ForeignFile& file, const Script& script) : file_(file), script_(script) {
    read_settings();
    analysis_.emplace(script_, limits_);
    limited_ = analysis_->generations().has_value();
    sized_ = limits_.least_size || limits_.most_size;
    if (const Group* const group = analysis_->too_deep()) {
        file_.diagnostics
            .error(script_.rules[group->rules.front()].name.span,
                   fmt::format("more than {} depths of rules ('maxdepth') count together here",
                               Analysis::most_counters))
            .with_hint(
                "rules that lead to each other know the depths of all: give fewer of them a 'maxdepth'");
        return;
    }
    if (analysis_->gave_up())
        file_.diagnostics
            .warning(
                file_.span(0, 0),
                fmt::format("the objects of this script take too long to count: graftal stops after the {} "
                            "generations that it counted, and Structure Synth may go on",
                            *analysis_->generations()))
            .with_hint("'set maxdepth' with a smaller number ends both at one generation");
    check_names();
}

Translation Writer::write() {
    comment("from EisenScript (Structure Synth)");
    write_scene();
    write_constants();
    if (limited_) {
        const std::string why =
            analysis_->by_objects()
                ? fmt::format("after {} generations, when there are {} objects ('set maxobjects')",
                              *analysis_->generations(), shortest(std::round(analysis_->objects())))
                : fmt::format("after {} generations ('set maxdepth')", *analysis_->generations());
        comment(fmt::format("n counts the generations that are left: Structure Synth stops {}", why));
    }
    write_rules();
    for (const std::string& words : script_.tail)
        comment(words);
    return std::move(out_);
}

// Names

void Writer::check_names() {
    for (const Constant& constant : script_.constants)
        if (is_identifier(constant.name) && constant.name != "edge" && !is_own_word(constant.name) &&
            !constant.name.starts_with("left"))
            constants_.insert(constant.name);
    for (const Group& group : analysis_->groups()) {
        if (group.name.empty()) {
            object_names_.emplace_back();
            continue;
        }
        object_names_.push_back(free_name(script_.rules[group.rules.front()].name.written));
    }
    object_names_[0] = free_name("start");
    counter_names_.resize(script_.rules.size());
    for (const Group& group : analysis_->groups())
        for (const std::size_t rule : group.counters) {
            const Group& of = analysis_->groups()[analysis_->group_of(rule)];
            std::string name =
                group.counters.size() == 1 ? "left" : "left_" + object_names_[analysis_->group_of(rule)];
            if (group.counters.size() > 1 && of.rules.size() > 1)
                name += fmt::format("_{}", std::ranges::find(of.rules, rule) - of.rules.begin() + 1);
            counter_names_[rule] = name;
        }
    // References to nothing, in the rules that are used or not, as in Structure Synth.
    static const std::set<std::string, std::less<>> primitives = {
        "box", "sphere", "grid", "line", "dot", "point", "cylinder", "mesh", "template", "tube"};
    std::vector<std::string> known(primitives.begin(), primitives.end());
    for (const Group& group : analysis_->groups())
        if (!group.name.empty()) known.push_back(group.name);
    const auto check = [&](const Token& token) {
        const std::string plain = token.text.substr(0, token.text.find("::"));
        if (analysis_->group(token.text) || primitives.contains(plain) || token.text.starts_with("triangle["))
            return;
        if (file_.diagnostics.full()) return;
        file_.diagnostics.error(token.span, fmt::format("unknown rule '{}'", token.written))
            .with_hint(did_you_mean(token.text, known));
    };
    for (const Rule& rule : script_.rules) {
        for (const Action& action : rule.actions)
            check(action.target);
        if (rule.fallback) check(*rule.fallback);
    }
}

std::string Writer::free_name(std::string_view wanted) {
    return free_own_name(wanted, "_rule", names_);
}

std::string Writer::counter_name(std::size_t rule) const {
    return counter_names_[rule];
}

std::string Writer::parameters(const Group& group) const {
    std::vector<std::string> names;
    if (limited_) names.emplace_back("n");
    for (const std::size_t rule : group.counters)
        names.push_back(counter_name(rule));
    if (sized_) names.emplace_back("edge");
    return names.empty() || group.name.empty() ? "" : fmt::format("({})", fmt::join(names, ", "));
}

void Writer::write_constants() {
    std::set<std::string> written;
    for (const Constant& constant : script_.constants) {
        if (!constants_.contains(constant.name) || !written.insert(constant.name).second) continue;
        const std::string remark = constant.remark.empty() ? "" : "   # " + comment_text(constant.remark);
        line(fmt::format("let {} = {}{}", constant.name, shortest(constant.number), remark), constant.span);
    }
}

std::string Writer::expression(const Value& value) const {
    return constants_.contains(value.constant) ? value.constant : shortest(value.number);
}

// Rules

void Writer::write_rules() {
    for (std::size_t rule = 0; rule < script_.rules.size(); ++rule)
        if (!stopped_ && !file_.diagnostics.full()) write_rule(rule);
    if (stopped_) return;
    line("");
    line(fmt::format("object {} {{", free_name("scene")));
    line(fmt::format("    instance: {}  ink: hsv(0, 1, 1)", object_names_[0]));
    line("}");
    for (const auto& [key, lines] : primitive_lines_) {
        line("");
        line(fmt::format("canonical object {} {{", primitive_names_.at(key)));
        for (const std::string& words : lines)
            line("    " + words);
        line("}");
    }
}

void Writer::write_rule(std::size_t index) {
    const Rule& rule = script_.rules[index];
    group_ = analysis_->group_of(index);
    const Group& group = analysis_->groups()[group_];
    line("");
    for (const std::string& words : rule.comments)
        comment(words);
    const bool top = index == 0;
    const std::string weight =
        group.rules.size() > 1 ? fmt::format(" weight {}", expression(rule.weight)) : std::string();
    line(fmt::format("canonical object {}{}{} {{", object_names_[group_], parameters(group), weight),
         top ? Span() : rule.name.span);
    ++depth_;
    std::string test;
    if (limited_ && !top) test = "n > 1";
    const auto also = [&](const std::string& more) { test += (test.empty() ? "" : " && ") + more; };
    const auto plain = [](double diagonal) { return shortest(diagonal / std::numbers::sqrt3); };
    if (sized_ && !top && limits_.least_size) also(fmt::format("edge >= {}", plain(*limits_.least_size)));
    if (sized_ && !top && limits_.most_size) also(fmt::format("edge <= {}", plain(*limits_.most_size)));
    if (!test.empty()) line(fmt::format("when {} {{", test)), ++depth_;
    write_body(rule, group, index);
    if (!test.empty()) --depth_, line("}");
    for (const std::string& words : rule.tail)
        comment(words);
    --depth_;
    line("}");
    // Objects for the inner loops of this one.
    for (std::size_t i = 0; i < wrappers_.size(); ++i) {
        const Wrapper wrapper = wrappers_[i];
        line("");
        line(fmt::format("canonical object {}{} {{", wrapper.name, parameters(group)), wrapper.span);
        ++depth_;
        write_loops(wrapper.loops, wrapper.target, wrapper.span);
        --depth_;
        line("}");
    }
    wrappers_.clear();
}

void Writer::write_body(const Rule& rule, const Group& group, std::size_t index) {
    const bool counted = std::ranges::find(group.counters, index) != group.counters.end();
    if (counted) line(fmt::format("when {} > 0 {{", counter_name(index)), rule.name.span), ++depth_;
    const std::size_t before = out_.text.size();
    for (const Action& action : rule.actions) {
        if (stopped_) return;
        for (const std::string& words : action.comments)
            comment(words);
        write_action(action, index);
    }
    if (out_.text.size() == before) line("nothing");
    if (!counted) return;
    --depth_;
    if (!rule.fallback) return line("}");
    line("} else {");
    ++depth_;
    if (analysis_->group(rule.fallback->text))
        line(fmt::format("instance: {}", reference(rule.fallback->text, group, index, true, 1)),
             rule.fallback->span);
    else
        write_action({.loops = {}, .target = *rule.fallback, .comments = {}, .span = rule.fallback->span},
                     index);
    --depth_;
    line("}");
}

std::string Writer::reference(const std::string& name, const Group& from, std::optional<std::size_t> rule,
                              bool same_generation, double growth) {
    const Group& to = *analysis_->group(name);
    const bool top = from.name.empty();
    std::vector<std::string> arguments;
    if (limited_) {
        const int generations = *analysis_->generations() - 1;
        const std::string left = same_generation ? "n" : "n - 1";
        if (top)
            arguments.push_back(std::to_string(
                to.endless ? generations : std::min<int>(generations, static_cast<int>(to.height))));
        else
            arguments.push_back(to.endless ? left : fmt::format("min({}, {})", left, to.height));
    }
    for (const std::size_t counter : to.counters) {
        const bool known = std::ranges::find(from.counters, counter) != from.counters.end();
        const std::string full = std::to_string(*script_.rules[counter].depth);
        if (!known || (rule == counter && same_generation))
            arguments.push_back(full);
        else
            arguments.push_back(rule == counter ? counter_name(counter) + " - 1" : counter_name(counter));
    }
    if (sized_) {
        const std::string size = top ? "1" : "edge";
        arguments.push_back(growth == 1 ? size
                            : top       ? shortest(growth)
                                        : fmt::format("edge * {}", shortest(growth)));
    }
    const std::string& object = object_names_[static_cast<std::size_t>(&to - analysis_->groups().data())];
    return arguments.empty() ? object : fmt::format("{}({})", object, fmt::join(arguments, ", "));
}

// Actions

void Writer::write_action(const Action& action, std::size_t from) {
    const std::string plain = action.target.text.substr(0, action.target.text.find("::"));
    const Group* const to = analysis_->group(action.target.text);
    if (!to && plain == "template") {
        file_.diagnostics.warning(action.span,
                                  "'template' draws nothing here: it is a text for other programs");
        return;
    }
    if (!to && plain == "mesh") {
        if (!action.loops.empty()) write_mesh(action); // else whoever calls this rule writes it
        return;
    }
    if (to && holds_mesh(*to) && !action.loops.empty()) write_mesh(action);
    if (!sized_) return write_loops(action.loops, target_of(action, from), action.span);
    // Each copy knows its own size.
    const Group& group = analysis_->groups()[analysis_->group_of(from)];
    std::vector<Loop> loops = {{}};
    loops[0].span = action.span;
    const bool grows =
        std::ranges::any_of(action.loops, [](const Loop& loop) { return growth_of(loop) != 1; });
    if (grows)
        for (const Loop& loop : action.loops) {
            std::vector<Loop> more;
            const auto count = static_cast<std::size_t>(copies_of(loop));
            if (!take(written_copies_, most_written_copies, loops.size() * count, loop.span,
                      "copies that change their size under 'minsize' or 'maxsize'"))
                return;
            for (const Loop& one : loops) {
                Loop copy = one;
                for (std::size_t i = 0; i < count; ++i) {
                    copy.operators.insert(copy.operators.end(), loop.operators.begin(), loop.operators.end());
                    if (!take(written_words_, most_written_words, copy.operators.size(), loop.span,
                              "operators of copies that change their size under 'minsize' or 'maxsize'"))
                        return;
                    more.push_back(copy);
                }
            }
            loops = std::move(more);
        }
    for (const Loop& one : loops) {
        const double growth = grows ? growth_of(one) : 1;
        std::string test;
        if (!to && growth != 1) {
            const std::string size =
                group.name.empty() ? shortest(growth) : fmt::format("edge * {}", shortest(growth));
            if (limits_.least_size)
                test = fmt::format("{} >= {}", size, shortest(*limits_.least_size / std::numbers::sqrt3));
            if (limits_.most_size)
                test += fmt::format("{}{} <= {}", test.empty() ? "" : " && ", size,
                                    shortest(*limits_.most_size / std::numbers::sqrt3));
        }
        if (!test.empty()) line(fmt::format("when {} {{", test), action.span), ++depth_;
        const std::string target =
            to ? reference(action.target.text, group, from, false, growth) : primitive(action);
        write_loops(grows ? std::vector<Loop>{one} : action.loops, target, action.span);
        if (!test.empty()) --depth_, line("}");
    }
}

/// Takes from what the whole script may write of something; false after the error that this is too much.
bool Writer::take(std::size_t& taken, std::size_t most, std::size_t count, Span span, std::string_view what) {
    if (stopped_) return false;
    taken += count;
    if (taken <= most) return true;
    stopped_ = true;
    file_.diagnostics.error(span, fmt::format("the script has more than {} {}", most, what))
        .with_hint("graftal writes them one by one: make the counts of the loops smaller");
    return false;
}

std::string Writer::target_of(const Action& action, std::size_t from) {
    const Group& group = analysis_->groups()[analysis_->group_of(from)];
    if (analysis_->group(action.target.text)) return reference(action.target.text, group, from, false, 1);
    return primitive(action);
}

void Writer::write_loops(const std::vector<Loop>& given, const std::string& target, Span span) {
    std::vector<Loop> loops;
    for (const Loop& loop : given) {
        const bool joins = !loops.empty() && copies_of(loop) == 1 && copies_of(loops.back()) == 1 &&
                           !(has_colours(loop.operators) && has_colours(loops.back().operators));
        if (joins)
            loops.back().operators.insert(loops.back().operators.end(), loop.operators.begin(),
                                          loop.operators.end());
        else
            loops.push_back(loop);
    }
    bool nest = true;
    for (std::size_t i = 0; i < loops.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            nest = nest && commute(map_of(loops[i]), map_of(loops[j]));
            nest = nest && !(has_colours(loops[i].operators) && has_colours(loops[j].operators) &&
                             (sets_colour(loops[i].operators) || sets_colour(loops[j].operators)));
        }
    if (loops.size() > 1 && !nest) {
        std::vector<Loop> inner(loops.begin() + 1, loops.end());
        const std::string name = free_name(fmt::format("{}_part", object_names_[group_]));
        const Group& group = analysis_->groups()[group_];
        wrappers_.push_back({name, std::move(inner), target, span});
        return write_loops({loops.front()}, name + parameters(group), span);
    }
    std::string repeats, own;
    for (const Loop& loop : loops) {
        const std::string moves = transforms(loop.operators), colours = inks(loop.operators);
        if (copies_of(loop) > 1)
            repeats += fmt::format("{} * {{{}{} }} ",
                                   constants_.contains(loop.count.constant) ? loop.count.constant
                                                                            : std::to_string(copies_of(loop)),
                                   moves, sets_colour(loop.operators) ? "" : colours);
        own.insert(0, moves);
    }
    for (const Loop& loop : loops)
        own += inks(loop.operators);
    std::string master = target;
    const bool pooled =
        std::ranges::any_of(loops, [](const Loop& loop) { return draws_colour(loop.operators); });
    if (pooled && !pool_colours_.empty()) {
        // An object that chance gives one of the colours.
        const Group& group = analysis_->groups()[group_];
        const std::string name = free_name(fmt::format("{}_coloured", object_names_[group_]));
        if (!take(written_words_, most_written_words, pool_colours_.size(), span,
                  "colours of pools, for each place that draws one"))
            return;
        for (const std::string& colour : pool_colours_)
            primitive_lines_[fmt::format("{}{} weight 1#{}", name, parameters(group), colour)] = {
                fmt::format("instance: {}  ink: {}", target, colour)};
        for (const std::string& colour : pool_colours_) {
            const std::string key = fmt::format("{}{} weight 1#{}", name, parameters(group), colour);
            primitive_names_[key] = fmt::format("{}{} weight 1", name, parameters(group));
        }
        master = name + parameters(group);
    }
    line(repeats.empty() ? fmt::format("instance: {}{}", master, own)
                         : fmt::format("{}{}{}", repeats, master, own),
         span);
}

/// Whether a rule of the group has a `mesh` without a place of its own: it leads from where the rule was
/// called to the rule.
bool Writer::holds_mesh(const Group& group) const {
    return std::ranges::any_of(group.rules, [&](std::size_t rule) {
        return std::ranges::any_of(script_.rules[rule].actions, [](const Action& action) {
            return action.loops.empty() && action.target.text.starts_with("mesh");
        });
    });
}

/// Faces between the plane where the parent stands and where each copy does.
void Writer::write_mesh(const Action& action) {
    std::vector<Affine> places = {Affine()};
    std::size_t count = 1;
    for (const Loop& loop : action.loops)
        count = std::min(most_written_copies + 1, count * static_cast<std::size_t>(copies_of(loop)));
    if (!take(written_copies_, most_written_copies, count, action.span, "copies of a 'mesh'")) return;
    for (const Loop& loop : action.loops) {
        std::vector<Affine> more;
        const Affine step = map_of(loop);
        for (const Affine& place : places) {
            Affine copy = place;
            for (int i = 0; i < copies_of(loop); ++i)
                more.push_back(copy = copy * step);
        }
        places = std::move(more);
    }
    std::string colours;
    for (const Loop& loop : action.loops)
        colours += inks(loop.operators);
    const Vec3 base[4] = {{-0.5, -0.5, -0.5}, {0.5, -0.5, -0.5}, {0.5, 0.5, -0.5}, {-0.5, 0.5, -0.5}};
    for (const Affine& place : places)
        for (int i = 0; i < 4; ++i) {
            const Vec3 a = base[i], b = base[(i + 1) % 4], c = place(a), d = place(b);
            for (const std::optional<std::string>& triangle : {triangle_map(a, b, c), triangle_map(b, d, c)})
                if (triangle) line(*triangle + colours, action.span);
        }
}

void Writer::comment(const std::string& words) {
    line("# " + comment_text(words));
}

void Writer::line(const std::string& words, Span origin) {
    out_.line(words.empty() ? words : std::string(static_cast<std::size_t>(4 * depth_), ' ') + words, origin);
}

} // namespace graftal::eisenscript
