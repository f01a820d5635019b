#include "compiler/editing/vary.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/editing/maps/map_form.h"
#include "compiler/editing/text_edit.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::size_t most_children = 100;
constexpr std::size_t most_tries = 8; // for each child
constexpr std::size_t most_changes = 4;

/// A number of [-1, 1), and never near to 0: a child that hardly changes shows nothing.
double change(RandomStream& draws) {
    const double size = 0.25 + 0.75 * draws.unit();
    return draws.unit() < 0.5 ? -size : size;
}

/// With three digits, as people write them.
double rounded(double value) {
    std::string text;
    append_number(text, value, 3);
    return parse_number(text).value_or(value);
}

bool is_whole(double value) {
    return value == std::floor(value) && std::abs(value) < 1e6;
}

// Parameters

/// Steps cost, and a seed has no near values.
bool can_vary(const ModelParameter& parameter) {
    return parameter.kind != ModelParameter::Kind::setting ||
           (parameter.name != "steps" && parameter.name != "seed");
}

double varied(const ModelParameter& parameter, double spread, RandomStream& draws) {
    const auto [least, most] = range_of(parameter);
    const double by = spread * change(draws) * (most - least) / 2;
    const bool whole =
        parameter.kind == ModelParameter::Kind::let && parameter.literal && is_whole(parameter.value);
    double value = parameter.value + by;
    if (whole)
        value = parameter.value + (by < 0 ? -1 : 1) * std::max(1.0, std::round(std::abs(by)));
    else
        value = rounded(value);
    return std::clamp(value, least, most);
}

Variation child_by_parameters(const std::vector<ModelParameter>& parameters, double spread,
                              RandomStream& draws) {
    Variation child;
    const std::size_t sure = draws.below(parameters.size());
    std::vector<std::string> says;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const bool changes = i == sure || draws.unit() < 0.5;
        const ModelParameter& parameter = parameters[i];
        const double value = varied(parameter, spread, draws);
        if (!changes || value == parameter.value) continue;
        child.set[parameter.name] = value;
        std::string was;
        append_number(was, parameter.value, 4);
        says.push_back(fmt::format("{} {} (was {})", parameter.name, shortest(value), was));
    }
    child.says = fmt::format("{}", fmt::join(says, ", "));
    return child;
}

// Rules

/// A word of the text that may become another.
struct Changeable {
    Span span;
    std::optional<double> number; ///< nothing: a symbol of the turtle
};

constexpr std::string_view turns[] = {"+", "-", "&", "^", "\\", "/"};

class Finder {
  public:
    explicit Finder(const Document& document) : document_(document) {}

    std::vector<Changeable> find() && {
        if (const LsysFile* tree = document_.lsys())
            for (const LsysBlock& block : tree->blocks)
                add(block);
        if (const RifsFile* tree = document_.rifs())
            for (const RifsBlock& block : tree->blocks)
                for (const RifsMap& map : block.maps) {
                    for (const Expression& code : map.codes)
                        numbers(code, true);
                    lines(map.transforms);
                }
        if (const InstModule* tree = document_.inst())
            for (const InstDefinition& definition : tree->definitions)
                for (const InstGroup& group : definition.groups)
                    lines(group.transforms);
        std::ranges::sort(found_, {}, [](const Changeable& one) { return one.span.begin; });
        const auto again = std::ranges::unique(found_, {}, &Changeable::span);
        found_.erase(again.begin(), again.end());
        return std::move(found_);
    }

  private:
    void add(const LsysBlock& block) {
        if (block.angle) numbers(block.angle->value, true);
        if (block.axiom) add(*block.axiom);
        for (const auto* productions : {&block.productions, &block.interpret, &block.decompose})
            for (const LsysProduction& production : *productions)
                add(production.successor);
    }

    void add(const LsysString& string) {
        for (const LsysModule& module : string.modules) {
            const TurtleCommand command = turtle_command(module.symbol);
            const bool turtle =
                command != TurtleCommand::none && command != TurtleCommand::model && module.symbol[0] != '?';
            if (std::ranges::count(turns, module.symbol) > 0)
                found_.push_back({document_.span_of(module.symbol), std::nullopt});
            // Whole numbers of other modules count steps.
            for (const Expression& parameter : module.parameters)
                numbers(parameter, turtle);
        }
    }

    void lines(const std::vector<TransformLine>& list) {
        for (const TransformLine& line : list)
            for (const Expression& number : line.numbers)
                numbers(number, true);
    }

    void numbers(const Expression& value, bool whole_too) {
        if (value.kind == Expression::Kind::number && value.number != 0 && value.span.known() &&
            (whole_too || !is_whole(value.number)))
            found_.push_back({value.span, value.number});
        for (const Expression& operand : value.operands)
            numbers(operand, whole_too);
    }

    const Document& document_;
    std::vector<Changeable> found_;
};

Variation child_by_rules(const Document& document, const std::vector<Changeable>& words, double spread,
                         RandomStream& draws) {
    const auto wanted = 1 + static_cast<std::size_t>(spread * (most_changes - 1) * draws.unit() + 0.5);
    std::set<std::size_t> chosen;
    for (std::size_t i = 0; i < wanted; ++i)
        chosen.insert(draws.below(words.size()));
    Variation child;
    std::vector<TextEdit> edits;
    std::vector<std::string> says;
    for (const std::size_t place : chosen) {
        const Changeable& word = words[place];
        const std::string_view old = document.text(word.span);
        std::string now;
        if (word.number) {
            const double value = rounded(*word.number * (1 + spread * change(draws)));
            if (value == *word.number) continue;
            now = number_text(value);
        } else {
            const std::string_view other = turns[draws.below(std::size(turns))];
            // The opposite is the likeliest of all.
            const auto at = static_cast<std::size_t>(std::ranges::find(turns, old) - std::begin(turns));
            now = draws.unit() < 0.5 || other == old ? turns[at ^ 1] : other;
        }
        const std::uint32_t line = document.sources().position(0, word.span.begin).line;
        says.push_back(word.number ? fmt::format("line {}: {} became {}", line, old, now)
                                   : fmt::format("line {}: '{}' became '{}'", line, old, now));
        edits.push_back({word.span.begin, word.span.end, std::move(now)});
    }
    child.says = fmt::format("{}", fmt::join(says, "; "));
    child.text = applied(document.text(), std::move(edits));
    return child;
}

bool is_sound(const Document& parent, const std::string& text, const EditContext& context) {
    const Document child(parent.name(), text);
    if (child.findings().has_errors()) return false;
    return parent.lsys() || check_contraction(parent.name(), text, context).contracts;
}

} // namespace

ParameterRange range_of(const ModelParameter& parameter) {
    if (parameter.kind == ModelParameter::Kind::inner) return {0, 1};
    if (parameter.value == 0) return {-1, 1};
    return {std::min(0.0, 2 * parameter.value), std::max(0.0, 2 * parameter.value)};
}

std::vector<Variation> vary(const Document& document, const std::vector<ModelParameter>& parameters,
                            const VariationOptions& options, const EditContext& context) {
    const std::size_t count = std::min(options.count, most_children);
    const double spread = std::clamp(options.spread, 0.0, 1.0);
    const CounterRandom random(options.seed);
    std::vector<ModelParameter> varying;
    std::ranges::copy_if(parameters, std::back_inserter(varying), can_vary);
    const std::vector<Changeable> words =
        options.kind == VariationKind::rules ? Finder(document).find() : std::vector<Changeable>();
    if (options.kind == VariationKind::parameters && varying.empty()) return {};
    if (options.kind == VariationKind::rules && words.empty()) return {};

    std::vector<Variation> children;
    std::set<std::string> known = {""};
    for (std::uint64_t number = 0; children.size() < count && number < count * most_tries; ++number) {
        RandomStream draws(random.sequence(number));
        Variation child;
        if (options.kind == VariationKind::seed) {
            constexpr double most_seed = 1e6; // short enough to be read
            child.seed = static_cast<std::uint64_t>(draws.unit() * most_seed);
            child.says = fmt::format("seed {}", *child.seed);
        } else if (options.kind == VariationKind::parameters) {
            child = child_by_parameters(varying, spread, draws);
        } else {
            child = child_by_rules(document, words, spread, draws);
        }
        if (!known.insert(child.says).second) continue;
        if (child.text && !is_sound(document, *child.text, context)) continue;
        children.push_back(std::move(child));
    }
    return children;
}

} // namespace graftal
