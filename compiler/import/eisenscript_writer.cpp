#include "compiler/import/eisenscript_writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/colour_names.h"
#include "compiler/import/importers.h"
#include "compiler/import/own_words.h"
#include "compiler/support/hue.h"
#include "compiler/support/number.h"
#include "compiler/support/srgb.h"

namespace graftal::eisenscript {

namespace {

/// Copies that are written one by one.
constexpr std::size_t most_written_copies = 10'000;
/// What a size of 0 becomes: graftal's maps must be regular.
constexpr double thinnest = 1e-4;

bool is_identifier(std::string_view name) {
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) return false;
    return std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

std::string hsv_text(const std::array<double, 3>& rgb) {
    const Hsv hsv = hsv_from_rgb(Rgb(rgb[0], rgb[1], rgb[2]));
    // To what screens tell apart.
    const auto rounded = [](double v) { return std::round(1e4 * v) / 1e4; };
    return fmt::format("hsv({}, {}, {})", shortest(rounded(hsv.hue_deg)), shortest(rounded(hsv.saturation)),
                       shortest(rounded(hsv.value)));
}

Hsv hsv_of(const std::array<double, 3>& rgb) {
    return hsv_from_rgb(Rgb(rgb[0], rgb[1], rgb[2]));
}

std::string linear_text(const std::array<double, 3>& rgb) {
    std::vector<std::string> parts;
    for (const double part : rgb)
        parts.push_back(shortest(std::round(1e5 * linear_from_srgb(part)) / 1e5));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string vector_text(Vec3 v) {
    return fmt::format("{}, {}, {}", shortest(v.x), shortest(v.y), shortest(v.z));
}

bool has_colours(const std::vector<Operator>& operators) {
    return std::ranges::any_of(operators, [](const Operator& op) { return !op.moves(); });
}

bool sets_colour(const std::vector<Operator>& operators) {
    return std::ranges::any_of(operators, [](const Operator& op) { return op.kind == Operator::Kind::colour; });
}

bool draws_colour(const std::vector<Operator>& operators) {
    return std::ranges::any_of(
        operators, [](const Operator& op) { return op.kind == Operator::Kind::colour && !op.colour; });
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

/// Maps the corners of our triangle to three points.
std::optional<std::string> triangle_map(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 middle = (a + b + c) / 3.0;
    const Vec3 up = a - middle, side = (c - b) / std::numbers::sqrt3;
    const Vec3 normal = glm::cross(side, up);
    const double area = glm::length(normal);
    if (!(area > 1e-9 * (glm::dot(side, side) + glm::dot(up, up)))) return std::nullopt;
    const Vec3 out = normal / std::sqrt(area);
    std::string text = "instance: triangle  matrix:";
    for (int row = 0; row < 3; ++row)
        text += fmt::format(" {}, {}, {}, {}{}", shortest(side[row]), shortest(up[row]), shortest(out[row]),
                            shortest(middle[row]), row < 2 ? ", " : "");
    return text;
}

} // namespace

Writer::Writer(const ForeignFile& file, const Script& script) : file_(file), script_(script) {
    read_settings();
    analysis_.emplace(script_, limits_);
    limited_ = analysis_->generations().has_value();
    sized_ = limits_.least_size || limits_.most_size;
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

// Settings

std::optional<double> Writer::number(const Setting& setting) {
    const std::optional<double> value = parse_number(setting.value);
    if (!value || !(std::abs(*value) <= 1e100))
        file_.diagnostics.error(setting.span, fmt::format("'{}' is not a number", setting.value));
    return value;
}

/// `[1 0 0]` or `[1,0,0]`.
std::vector<double> Writer::numbers(const Setting& setting, std::size_t count) {
    std::vector<double> values;
    std::string word;
    for (const char c : setting.value + " ") {
        if (c != ' ' && c != ',' && c != '[' && c != ']') {
            word += c;
            continue;
        }
        const std::optional<double> value = parse_number(word);
        if (value && std::abs(*value) <= 1e9) values.push_back(*value);
        word.clear();
    }
    if (values.size() != count)
        file_.diagnostics.error(setting.span, fmt::format("'{}' takes {} numbers in brackets", setting.key, count));
    return values;
}

void Writer::read_settings() {
    for (std::size_t rule = 0; rule < script_.rules.size(); ++rule)
        for (const Setting& setting : script_.rules[rule].settings) {
            if (rule == 0 || setting.key == "background")
                set(setting);
            else
                file_.diagnostics.warning(setting.span,
                                          fmt::format("'set {}' within a rule changes nothing here", setting.key));
        }
}

void Writer::set(const Setting& setting) {
    const std::string& key = setting.key;
    const auto whole = [&](double most) -> std::optional<double> {
        const std::optional<double> value = number(setting);
        if (!value || (*value == std::floor(*value) && *value >= 0)) return value ? std::optional(std::min(*value, most)) : value;
        file_.diagnostics.error(setting.span, fmt::format("'{}' is a whole number", key));
        return std::nullopt;
    };
    if (key == "maxdepth" || key == "md") {
        if (const auto value = whole(1e6)) limits_.generations = static_cast<int>(*value);
    } else if (key == "maxobjects") {
        if (const auto value = whole(1e12)) limits_.objects = *value;
    } else if (key == "minsize") {
        limits_.least_size = number(setting);
    } else if (key == "maxsize") {
        limits_.most_size = number(setting);
    } else if (key == "background") {
        background_ = colour_named(setting.value);
        if (!background_) file_.diagnostics.error(setting.span, fmt::format("'{}' is not a colour", setting.value));
    } else if (key == "colorpool") {
        pool_ = setting.value;
        std::ranges::transform(pool_, pool_.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (pool_ == "grayscale") pool_ = "greyscale";
        if (pool_.starts_with("list:")) {
            pool_colours_.clear();
            std::string_view rest = std::string_view(pool_).substr(5);
            while (true) {
                const std::size_t comma = std::min(rest.find(','), rest.size());
                const auto rgb = colour_named(rest.substr(0, comma));
                if (!rgb)
                    file_.diagnostics.error(setting.span, fmt::format("'{}' is not a colour", rest.substr(0, comma)));
                else
                    pool_colours_.push_back(hsv_text(*rgb));
                if (comma == rest.size()) break;
                rest.remove_prefix(comma + 1);
            }
        } else if (pool_.starts_with("image:")) {
            file_.diagnostics.error(setting.span, "a pool of colours from a picture ('image:') is not translated")
                .with_hint("name the colours: set colorpool list:orange,#346");
        } else if (pool_ != "randomhue" && pool_ != "randomrgb" && pool_ != "greyscale") {
            file_.diagnostics.error(setting.span, fmt::format("unknown pool of colours '{}'", setting.value));
        }
    } else if (key == "translation" || key == "pivot") {
        (key == "pivot" ? camera_.pivot : camera_.translation) = numbers(setting, 3);
    } else if (key == "rotation") {
        camera_.rotation = numbers(setting, 9);
    } else if (key == "scale") {
        camera_.scale = number(setting);
    } else if (key == "perspective-angle") {
        camera_.angle_deg = number(setting);
    } else if (key == "seed") {
        file_.diagnostics.note(setting.span, "the seed is an option here, and chooses other numbers: --seed");
    } else if (key == "recursion" || key == "syncrandom" || key == "rng" || key == "template" || key == "opengl") {
        file_.diagnostics.warning(setting.span, fmt::format("'set {} {}' changes nothing here", key, setting.value));
    } else if (key.starts_with("raytracer::")) {
        const std::string rest = key.substr(11);
        const std::size_t colons = rest.find("::");
        const std::string of = colons == std::string::npos ? "" : rest.substr(0, colons);
        const std::string what = colons == std::string::npos ? rest : rest.substr(colons + 2);
        if (!of.empty() && what == "reflection") {
            finishes_[of].reflection = number(setting);
        } else if (!of.empty() && what == "phong") {
            const std::vector<double> phong = numbers(setting, 3);
            if (phong.size() == 3) {
                finishes_[of].ambient = phong[0];
                finishes_[of].diffuse = phong[1];
                finishes_[of].specular = phong[2];
            }
        } else {
            file_.diagnostics.warning(setting.span, fmt::format("'{}' is of Structure Synth's own raytracer, and "
                                                                "changes nothing here", key));
        }
    } else {
        file_.diagnostics.error(setting.span, fmt::format("unknown setting '{}'", key));
    }
}

void Writer::write_scene() {
    if (background_) line(fmt::format("background: {}", linear_text(*background_)));
    write_camera();
    for (const auto& [name, finish] : finishes_) {
        std::string fields;
        const auto add = [&](const char* field, const std::optional<double>& value) {
            if (value) fields += fmt::format("  {}: {}", field, shortest(std::clamp(*value, 0.0, 1.0)));
        };
        add("ambient", finish.ambient);
        add("diffuse", finish.diffuse);
        add("specular", finish.specular);
        add("reflection", finish.reflection);
        line(fmt::format("material {} {{{} }}", plain_name(name), fields));
    }
}

/// Structure Synth moves the scene: eye = translation + scale * rotation * (point - pivot), and looks along -z.
void Writer::write_camera() {
    if (!camera_.translation || camera_.translation->size() != 3 || !camera_.scale || !(*camera_.scale > 0)) return;
    Mat3 eye_from_world(1.0);
    if (camera_.rotation && camera_.rotation->size() == 9)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                eye_from_world[column][row] = (*camera_.rotation)[static_cast<std::size_t>(3 * row + column)];
    Vec3 pivot(0.0);
    if (camera_.pivot && camera_.pivot->size() == 3) pivot = {(*camera_.pivot)[0], (*camera_.pivot)[1], (*camera_.pivot)[2]};
    const Vec3 moved((*camera_.translation)[0], (*camera_.translation)[1], (*camera_.translation)[2]);
    const Mat3 world_from_eye = glm::transpose(eye_from_world);
    const Vec3 location = pivot - Vec3(0.5) - world_from_eye * moved / *camera_.scale;
    const Vec3 ahead = world_from_eye * Vec3(0, 0, -1), up = world_from_eye * Vec3(0, 1, 0);
    const double distance = std::max(1e-3, std::abs(moved.z) / *camera_.scale);
    const auto rounded = [](Vec3 v) { return vector_text(glm::round(1e5 * v) / 1e5); };
    if (!(glm::length(glm::cross(ahead, up)) > 0.1)) return;
    const double upright = std::clamp(camera_.angle_deg.value_or(22), 1.0, 150.0) * std::numbers::pi / 180;
    const double across = 2 * std::atan(std::tan(upright / 2) * 16 / 9) * 180 / std::numbers::pi;
    line(fmt::format("camera {{ location: {}  look_at: {}  up: {}  angle: {} }}", rounded(location),
                     rounded(location + distance * ahead), rounded(up), shortest(std::round(100 * across) / 100)));
}

// Names

void Writer::check_names() {
    for (const Constant& constant : script_.constants)
        if (is_identifier(constant.name) && !is_own_word(constant.name) &&
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
            std::string name = group.counters.size() == 1 ? "left" : "left_" + object_names_[analysis_->group_of(rule)];
            if (group.counters.size() > 1 && of.rules.size() > 1)
                name += fmt::format("_{}", std::ranges::find(of.rules, rule) - of.rules.begin() + 1);
            counter_names_[rule] = name;
        }
    // References to nothing, in the rules that are used or not, as in Structure Synth.
    static const std::set<std::string, std::less<>> primitives = {"box",  "sphere",   "grid", "line",     "dot",
                                                                  "point", "cylinder", "mesh", "template", "tube"};
    const auto check = [&](const Token& token) {
        const std::string plain = token.text.substr(0, token.text.find("::"));
        if (analysis_->group(token.text) || primitives.contains(plain) || token.text.starts_with("triangle[")) return;
        std::vector<std::string> known(primitives.begin(), primitives.end());
        for (const Group& group : analysis_->groups())
            if (!group.name.empty()) known.push_back(group.name);
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
    std::string name = plain_name(wanted);
    if (is_own_word(name)) name += "_rule";
    std::string free = name;
    for (int i = 2; !names_.insert(free).second; ++i)
        free = fmt::format("{}_{}", name, i);
    return free;
}

std::string Writer::counter_name(std::size_t rule) const {
    return counter_names_[rule];
}

std::string Writer::parameters(const Group& group) const {
    std::vector<std::string> names;
    if (limited_) names.emplace_back("n");
    for (const std::size_t rule : group.counters)
        names.push_back(counter_name(rule));
    if (sized_) names.emplace_back("size");
    return names.empty() || group.name.empty() ? "" : fmt::format("({})", fmt::join(names, ", "));
}

void Writer::write_constants() {
    std::set<std::string> written;
    for (const Constant& constant : script_.constants) {
        if (!constants_.contains(constant.name) || !written.insert(constant.name).second) continue;
        const std::string remark = constant.remark.empty() ? "" : "   # " + constant.remark;
        line(fmt::format("let {} = {}{}", constant.name, shortest(constant.number), remark), constant.span);
    }
}

std::string Writer::expression(const Value& value) const {
    return constants_.contains(value.constant) ? value.constant : shortest(value.number);
}

// Rules

void Writer::write_rules() {
    for (std::size_t rule = 0; rule < script_.rules.size(); ++rule)
        if (!file_.diagnostics.full()) write_rule(rule);
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
    if (sized_ && !top && limits_.least_size) also(fmt::format("size >= {}", plain(*limits_.least_size)));
    if (sized_ && !top && limits_.most_size) also(fmt::format("size <= {}", plain(*limits_.most_size)));
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
        line(fmt::format("instance: {}", reference(rule.fallback->text, group, index, true, 1)), rule.fallback->span);
    else
        write_action({.loops = {}, .target = *rule.fallback, .comments = {}, .span = rule.fallback->span}, index);
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
            arguments.push_back(std::to_string(to.endless ? generations
                                                          : std::min<int>(generations, static_cast<int>(to.height))));
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
        const std::string size = top ? "1" : "size";
        arguments.push_back(growth == 1 ? size : top ? shortest(growth) : fmt::format("size * {}", shortest(growth)));
    }
    const std::string& object = object_names_[static_cast<std::size_t>(&to - analysis_->groups().data())];
    return arguments.empty() ? object : fmt::format("{}({})", object, fmt::join(arguments, ", "));
}

// Actions

void Writer::write_action(const Action& action, std::size_t from) {
    const std::string plain = action.target.text.substr(0, action.target.text.find("::"));
    const Group* const to = analysis_->group(action.target.text);
    if (!to && plain == "template") {
        file_.diagnostics.warning(action.span, "'template' draws nothing here: it is a text for other programs");
        return;
    }
    if (!to && plain == "mesh") return write_mesh(action);
    if (!sized_) return write_loops(action.loops, target_of(action, from), action.span);
    // Each copy knows its own size.
    const Group& group = analysis_->groups()[analysis_->group_of(from)];
    std::vector<Loop> loops = {{}};
    loops[0].span = action.span;
    const bool grows = std::ranges::any_of(action.loops, [](const Loop& loop) { return growth_of(loop) != 1; });
    std::size_t copies = 1;
    if (grows)
        for (const Loop& loop : action.loops) {
            std::vector<Loop> more;
            copies *= static_cast<std::size_t>(copies_of(loop));
            if (copies > most_written_copies) {
                file_.diagnostics.error(loop.span, "with 'minsize' or 'maxsize', copies that change their size are at most "
                                                   "10000");
                return;
            }
            for (const Loop& one : loops) {
                Loop copy = one;
                for (int i = 0; i < copies_of(loop); ++i) {
                    copy.operators.insert(copy.operators.end(), loop.operators.begin(), loop.operators.end());
                    more.push_back(copy);
                }
            }
            loops = std::move(more);
        }
    for (const Loop& one : loops) {
        const double growth = grows ? growth_of(one) : 1;
        std::string test;
        if (!to && growth != 1) {
            const std::string size = group.name.empty() ? shortest(growth) : fmt::format("size * {}", shortest(growth));
            if (limits_.least_size)
                test = fmt::format("{} >= {}", size, shortest(*limits_.least_size / std::numbers::sqrt3));
            if (limits_.most_size)
                test += fmt::format("{}{} <= {}", test.empty() ? "" : " && ", size,
                                    shortest(*limits_.most_size / std::numbers::sqrt3));
        }
        if (!test.empty()) line(fmt::format("when {} {{", test), action.span), ++depth_;
        const std::string target = to ? reference(action.target.text, group, from, false, growth) : primitive(action);
        write_loops(grows ? std::vector<Loop>{one} : action.loops, target, action.span);
        if (!test.empty()) --depth_, line("}");
    }
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
            loops.back().operators.insert(loops.back().operators.end(), loop.operators.begin(), loop.operators.end());
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
        own = moves + own;
    }
    for (const Loop& loop : loops)
        own += inks(loop.operators);
    std::string master = target;
    const bool pooled = std::ranges::any_of(loops, [](const Loop& loop) { return draws_colour(loop.operators); });
    if (pooled && !pool_colours_.empty()) {
        // An object that chance gives one of the colours.
        const Group& group = analysis_->groups()[group_];
        const std::string name = free_name(fmt::format("{}_coloured", object_names_[group_]));
        for (const std::string& colour : pool_colours_)
            primitive_lines_[fmt::format("{}{} weight 1#{}", name, parameters(group), colour)] = {
                fmt::format("instance: {}  ink: {}", target, colour)};
        for (const std::string& colour : pool_colours_) {
            const std::string key = fmt::format("{}{} weight 1#{}", name, parameters(group), colour);
            primitive_names_[key] = fmt::format("{}{} weight 1", name, parameters(group));
        }
        master = name + parameters(group);
    }
    line(repeats.empty() ? fmt::format("instance: {}{}", master, own) : fmt::format("{}{}{}", repeats, master, own),
         span);
}

/// Faces between the plane where the parent stands and where each copy does.
void Writer::write_mesh(const Action& action) {
    std::vector<Affine> places = {Affine()};
    for (const Loop& loop : action.loops) {
        std::vector<Affine> more;
        const Affine step = map_of(loop);
        for (const Affine& place : places) {
            Affine copy = place;
            for (int i = 0; i < copies_of(loop) && more.size() <= most_written_copies; ++i)
                more.push_back(copy = copy * step);
        }
        places = std::move(more);
    }
    if (action.loops.empty() || places.size() > most_written_copies) {
        file_.diagnostics.error(action.span, action.loops.empty() ? "a 'mesh' needs a place before it, in braces"
                                                                  : "too many copies of a 'mesh'");
        return;
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

// Primitives

std::string Writer::triangle_object(const Token& token) {
    std::vector<double> numbers;
    std::string word;
    for (const char c : token.text.substr(9)) {
        if (c != ',' && c != ';' && c != ']') {
            if (c != ' ') word += c;
            continue;
        }
        const std::optional<double> value = parse_number(word);
        if (value && std::abs(*value) <= 1e9) numbers.push_back(*value - 0.5);
        word.clear();
    }
    std::optional<std::string> map;
    if (numbers.size() == 9)
        map = triangle_map({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]},
                           {numbers[6], numbers[7], numbers[8]});
    if (!map) {
        file_.diagnostics.error(token.span, "a triangle is written triangle[0,0,0;1,0,0;0.5,1,0.5]")
            .with_hint("its corners must not lie on one line");
        return "nothing";
    }
    auto [known, fresh] = primitive_names_.try_emplace(*map);
    if (fresh) {
        known->second = free_name("triangle_1");
        primitive_lines_[*map] = {*map};
    }
    return known->second;
}

std::string Writer::primitive(const Action& action) {
    const std::string& text = action.target.text;
    if (text.starts_with("triangle[")) return triangle_object(action.target);
    const std::size_t colons = text.find("::");
    const std::string kind = text.substr(0, colons);
    const std::string of = colons == std::string::npos ? "" : plain_name(text.substr(colons + 2));
    auto [known, fresh] = primitive_names_.try_emplace(text);
    if (!fresh) return known->second;
    known->second = free_name(of.empty() ? (kind == "sphere" ? "ball" : kind == "cylinder" ? "rod" : kind)
                                         : fmt::format("{}_{}", of, kind));
    std::vector<std::string>& lines = primitive_lines_[text];
    if (kind == "box") {
        lines = {"instance: cube  scale: 0.5"};
    } else if (kind == "sphere") {
        lines = {"instance: sphere  scale: 0.5"};
    } else if (kind == "dot" || kind == "point") {
        lines = {"instance: sphere  scale: 0.02"};
    } else if (kind == "line") {
        lines = {"instance: cylinder  scale: 0.01, 1, 0.01  rotate: z, -90  translate: -0.5, 0, 0"};
    } else if (kind == "cylinder" || kind == "tube") {
        lines = {"instance: cylinder  scale: 0.5, 1, 0.5  rotate: x, 90  translate: 0, 0, -0.5"};
    } else { // the edges of a box
        for (const auto& [turn, axis] : {std::pair{"z, -90", 'x'}, {"", 'y'}, {"x, 90", 'z'}})
            for (const double a : {-0.5, 0.5})
                for (const double b : {-0.5, 0.5}) {
                    const Vec3 at = axis == 'x' ? Vec3(-0.5, a, b) : axis == 'y' ? Vec3(a, -0.5, b) : Vec3(a, b, -0.5);
                    lines.push_back(fmt::format("instance: cylinder  scale: 0.01, 1, 0.01{}  translate: {}",
                                                *turn ? fmt::format("  rotate: {}", turn) : "", vector_text(at)));
                }
    }
    if (finishes_.contains(text.substr(std::min(text.size(), colons + 2))) && colons != std::string::npos)
        for (std::string& words : lines)
            words += fmt::format("  material: {}", of);
    return known->second;
}

// Lines

std::string Writer::transforms(const std::vector<Operator>& operators) {
    std::string text;
    std::array<std::string, 3> moved;
    const auto flush = [&] {
        if (moved[0].empty() && moved[1].empty() && moved[2].empty()) return;
        for (std::string& part : moved)
            if (part.empty()) part = "0";
        text += fmt::format("  translate: {}, {}, {}", moved[0], moved[1], moved[2]);
        moved = {};
    };
    for (auto op = operators.rbegin(); op != operators.rend(); ++op) {
        if (!op->moves()) continue;
        if (op->kind <= Operator::Kind::z) {
            std::string& part = moved[static_cast<std::size_t>(op->kind)];
            const std::string offset = expression(op->numbers[0]);
            part = part.empty() ? offset : fmt::format("{} + {}", offset, part);
            continue;
        }
        flush();
        if (op->kind <= Operator::Kind::rz) {
            const char axis = "xyz"[static_cast<int>(op->kind) - static_cast<int>(Operator::Kind::rx)];
            text += fmt::format("  rotate: {}, {}", axis, expression(op->numbers[0]));
        } else if (op->kind == Operator::Kind::size) {
            std::vector<std::string> factors;
            for (const Value& value : op->numbers) {
                if (value.number == 0)
                    file_.diagnostics.warning(op->span, "a size of 0 becomes 0.0001");
                factors.push_back(value.number == 0 ? shortest(thinnest) : expression(value));
            }
            text += fmt::format("  scale: {}", fmt::join(factors, ", "));
        } else {
            Loop alone; // a temporary is a false alarm of GCC 12
            alone.operators.push_back(*op);
            const Affine map = map_of(alone);
            if (is_singular(map))
                file_.diagnostics.error(op->span, "this matrix is singular: it flattens what it maps");
            text += "  matrix:";
            for (int row = 0; row < 3; ++row)
                text += fmt::format(" {}, {}, {}, {}{}", shortest(map.linear[0][row]), shortest(map.linear[1][row]),
                                    shortest(map.linear[2][row]), shortest(map.translation[row]), row < 2 ? "," : "");
        }
    }
    flush();
    return text;
}

/// As Structure Synth adds the operators of one list up: colours that are set and changed in one are set.
std::string Writer::inks(const std::vector<Operator>& operators) {
    std::array<double, 4> change = {0, 1, 1, 1};
    std::array<std::string, 4> words;
    bool set = false, drawn = false;
    const Operator* blend = nullptr;
    for (const Operator& op : operators) {
        if (op.kind == Operator::Kind::blend && op.numbers[0].number > 0) blend = &op;
        if (op.kind == Operator::Kind::colour) {
            drawn = !op.colour;
            if (op.colour) {
                const Hsv hsv = hsv_of(*op.colour);
                if (set) change = {0, 1, 1, 1};
                change[0] += hsv.hue_deg, change[1] *= hsv.saturation, change[2] *= hsv.value;
            }
            set = true;
        }
        if (op.kind < Operator::Kind::hue || op.kind > Operator::Kind::alpha) continue;
        const auto channel = static_cast<std::size_t>(op.kind) - static_cast<std::size_t>(Operator::Kind::hue);
        const double number = op.numbers[0].number;
        words[channel] = words[channel].empty() && number >= 0 ? expression(op.numbers[0]) : "";
        change[channel] = channel == 0 ? change[channel] + number : change[channel] * number;
    }
    for (std::size_t i = 1; i < 4; ++i)
        change[i] = std::clamp(change[i], 0.0, set ? 1.0 : 1e6);
    drawn = drawn || (set && change[0] > 360);
    std::string text;
    if (drawn) {
        if (pool_ == "randomrgb")
            text = "  ink: random(0, 1), random(0, 1), random(0, 1)";
        else if (pool_ == "greyscale")
            text = "  ink: hsv(0, 0, random(0, 1))";
        else if (pool_colours_.empty())
            text = "  ink: hsv(random(0, 360), 1, 1)";
    } else if (set) {
        const auto rounded = [](double v) { return shortest(std::round(1e4 * v) / 1e4); };
        text = fmt::format("  ink: hsv({}, {}, {})", rounded(change[0]), rounded(change[1]), rounded(change[2]));
        if (change[3] < 1) text += fmt::format("  ink {{ alpha {} }}", shortest(change[3]));
    } else {
        static constexpr std::array channels = {"hue", "saturation", "value", "alpha"};
        std::string changes;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool same = change[i] == (i == 0 ? 0 : 1);
            if (same && (words[i].empty() || !constants_.contains(words[i]))) continue;
            changes += fmt::format(" {} {}", channels[i], constants_.contains(words[i]) ? words[i] : shortest(change[i]));
        }
        if (!changes.empty()) text = fmt::format("  ink {{{} }}", changes);
    }
    if (blend) {
        const Hsv hsv = hsv_of(*blend->colour);
        const double share = blend->numbers[0].number / (1 + blend->numbers[0].number);
        text += fmt::format("  ink {{ hue to {1} by {0} saturation to {2} by {0} value to {3} by {0} }}",
                            shortest(share), shortest(hsv.hue_deg), shortest(hsv.saturation), shortest(hsv.value));
    }
    return text;
}

void Writer::comment(const std::string& words) {
    std::string clean;
    for (const char c : words)
        clean += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    line("# " + clean);
}

void Writer::line(const std::string& words, Span origin) {
    out_.line(words.empty() ? words : std::string(static_cast<std::size_t>(4 * depth_), ' ') + words, origin);
}

} // namespace graftal::eisenscript
