#include "compiler/zoom/address.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

using Steps = std::vector<AddressStep>;

class Parser {
  public:
    Parser(std::string_view text, std::string& problem) : text_(text), problem_(problem) {}

    std::optional<Address> run() {
        const std::optional<Steps> steps = address(0);
        if (!steps) return std::nullopt;
        if (place_ < text_.size()) return fail(fmt::format("unexpected '{}'", text_[place_]));
        return Address{*steps, cycle_};
    }

  private:
    static constexpr int deepest = 100;

    std::nullopt_t fail(std::string problem) {
        if (problem_.empty()) problem_ = fmt::format("{} at character {}", problem, place_ + 1);
        return std::nullopt;
    }

    bool take(char c) {
        if (place_ >= text_.size() || text_[place_] != c) return false;
        ++place_;
        return true;
    }

    std::optional<Steps> address(int depth) {
        if (depth > deepest) return fail("the brackets nest too deep");
        Steps steps;
        do {
            if (!cycle_.empty()) return fail("no step can follow an endless repetition");
            std::optional<Steps> next = part(depth);
            if (!next) return std::nullopt;
            if (steps.size() + next->size() > most_address_steps)
                return fail(fmt::format("more than {} steps", most_address_steps));
            steps.insert(steps.end(), next->begin(), next->end());
        } while (take('.'));
        return steps;
    }

    std::optional<Steps> part(int depth) {
        Steps steps;
        if (take('(')) {
            std::optional<Steps> inner = address(depth + 1);
            if (!inner) return std::nullopt;
            if (!cycle_.empty()) return fail("only the end of an address can repeat forever");
            if (!take(')')) return fail("')' expected");
            steps = std::move(*inner);
        } else {
            std::optional<AddressStep> one = step();
            if (!one) return std::nullopt;
            steps.push_back(std::move(*one));
        }
        if (!take('*')) return steps;
        if (place_ >= text_.size() || !std::isdigit(static_cast<unsigned char>(text_[place_]))) {
            if (depth > 0) return fail("only the end of an address can repeat forever");
            cycle_ = std::move(steps);
            return Steps{};
        }
        const std::optional<std::uint32_t> count = number();
        if (!count || steps.size() * static_cast<std::size_t>(*count) > most_address_steps)
            return fail(fmt::format("more than {} steps", most_address_steps));
        Steps all;
        for (std::uint32_t i = 0; i < *count; ++i)
            all.insert(all.end(), steps.begin(), steps.end());
        return all;
    }

    std::optional<AddressStep> step() {
        AddressStep step;
        if (take('"')) {
            const std::size_t end = text_.find('"', place_);
            if (end == std::string_view::npos) return fail("the closing quote is missing");
            step.name = text_.substr(place_, end - place_);
            place_ = end + 1;
            if (step.name.empty()) return fail("an empty name");
        } else {
            step.name = word();
        }
        if (take('#')) {
            const std::optional<std::uint32_t> index = number();
            if (!index || *index == 0) return fail("expected a number, 1 or more, after '#'");
            step.index = *index;
        } else if (step.name.empty()) {
            return fail(place_ < text_.size() ? fmt::format("expected a name, not '{}'", text_[place_])
                                              : "expected a name");
        }
        return step;
    }

    /// A name with the arguments that stand behind it.
    std::string word() {
        const std::size_t begin = place_;
        const auto in_name = [](char c) {
            return std::string_view(".()*#\"").find(c) == std::string_view::npos;
        };
        while (place_ < text_.size() && in_name(text_[place_]))
            ++place_;
        if (place_ > begin && place_ < text_.size() && text_[place_] == '(')
            place_ = std::min(text_.find(')', place_), text_.size() - 1) + 1;
        return std::string(text_.substr(begin, place_ - begin));
    }

    std::optional<std::uint32_t> number() {
        std::uint32_t value = 0;
        const char* const begin = text_.data() + place_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc()) return std::nullopt;
        place_ += static_cast<std::size_t>(end - begin);
        return value;
    }

    std::string_view text_;
    std::string& problem_;
    std::size_t place_ = 0;
    Steps cycle_;
};

/// `arm` for `arm.v3.hue1`: without the numbers that `.inst` gives to variants and turns of hue.
std::string_view without_numbers(std::string_view head) {
    constexpr std::string_view digits = "0123456789";
    for (std::size_t dot = head.rfind('.'); dot != std::string_view::npos; dot = head.rfind('.')) {
        const std::string_view ending = head.substr(dot + 1);
        const std::string_view word = ending.substr(0, ending.find_last_not_of(digits) + 1);
        if (word == ending || (word != "v" && word != "hue")) break;
        head = head.substr(0, dot);
    }
    return head;
}

/// Fit of a master's name, 0 for none at all.
int fit(std::string_view master, std::string_view name) {
    if (name.empty() || master == name) return 4;
    const std::size_t end = std::min(master.find('('), master.size());
    const std::string_view arguments = master.substr(end);
    const std::string_view head = without_numbers(master.substr(0, end));
    const std::string_view last = head.substr(head.rfind('.') + 1);
    const auto with_arguments = [&](std::string_view begin) {
        return name.size() == begin.size() + arguments.size() && name.starts_with(begin) &&
               name.ends_with(arguments);
    };
    if (with_arguments(head)) return 3;
    if (with_arguments(last)) return 2;
    return head == name || last == name ? 1 : 0;
}

class Finder {
  public:
    Finder(const Graph& graph, Diagnostics& diagnostics, const Control& control)
        : graph_(graph), diagnostics_(diagnostics), meter_(control, "address", 1 << 16, StagePrice::name),
          object_(graph.root) {}

    std::optional<GraphPath> run(const Address& address) {
        for (const AddressStep& step : address.steps)
            if (follow(step, false) != Outcome::taken) return std::nullopt;
        std::unordered_map<ObjectId, std::size_t> starts; // of rounds, with the steps before each
        while (!address.cycle.empty()) {
            const auto [start, fresh] = starts.try_emplace(object_, path_.steps.size());
            if (!fresh) {
                path_.cycle.assign(path_.steps.begin() + static_cast<std::ptrdiff_t>(start->second),
                                   path_.steps.end());
                path_.steps.resize(start->second);
                break;
            }
            const bool may_end = starts.size() > 1;
            for (const AddressStep& step : address.cycle) {
                const Outcome outcome = follow(step, may_end);
                if (outcome == Outcome::refused) return std::nullopt;
                if (outcome == Outcome::ends) return path_;
            }
        }
        return path_;
    }

  private:
    enum class Outcome { taken, ends, refused };

    /// Instances of the best fit.
    std::vector<std::uint32_t> fitting(const Object& object, const std::string& name) {
        meter_.add(1 + object.instances.size());
        std::vector<std::uint32_t> found;
        int best = 1;
        for (std::uint32_t i = 0; i < object.instances.size(); ++i) {
            const int how_well = fit(graph_.objects[object.instances[i].master].name, name);
            if (how_well > best) found.clear();
            best = std::max(best, how_well);
            if (how_well >= best) found.push_back(i);
        }
        return found;
    }

    Outcome take(std::uint32_t instance) {
        if (path_.steps.size() == most_address_steps) return refuse_long();
        path_.steps.push_back({object_, instance});
        object_ = graph_.objects[object_].instances[instance].master;
        return Outcome::taken;
    }

    /// Takes one step. Where there is none the path ends if it `may_end`.
    Outcome follow(const AddressStep& step, bool may_end) {
        for (std::size_t passed = 0;; ++passed) {
            const Object& object = graph_.objects[object_];
            const std::vector<std::uint32_t> found = fitting(object, step.name);
            if (step.index > 0 && step.index <= found.size()) return take(found[step.index - 1]);
            if (step.index == 0 && found.size() == 1) return take(found[0]);
            if (step.index == 0 && found.size() > 1) return refuse_ambiguous(object, step, found.size());
            if (object.instances.size() != 1 || passed > graph_.objects.size())
                return may_end ? Outcome::ends : refuse_missing(object, step, found.size());
            if (const Outcome passage = take(0); passage != Outcome::taken) return passage;
        }
    }

    Outcome refuse_long() {
        diagnostics_
            .error(graph_.objects[graph_.root].span,
                   fmt::format("the address leads through more than {} instances", most_address_steps))
            .with_hint("repeat fewer steps, or give an endless repetition a count");
        return Outcome::refused;
    }

    Outcome refuse_ambiguous(const Object& object, const AddressStep& step, std::size_t count) {
        const std::string name = step.name.empty() ? "part" : step.name;
        diagnostics_
            .error(object.span, fmt::format("the address is ambiguous: '{}' has {} instances of '{}'",
                                            object.name, count, name))
            .with_hint(fmt::format("say which: {0}#1 to {0}#{1}", step.name, count));
        return Outcome::refused;
    }

    Outcome refuse_missing(const Object& object, const AddressStep& step, std::size_t count) {
        constexpr std::size_t most_names = 12;
        const std::string wanted =
            step.index == 0 ? fmt::format("'{}'", step.name) : fmt::format("'{}#{}'", step.name, step.index);
        Diagnostic& error = diagnostics_.error(
            object.span, fmt::format("the address does not exist: '{}' has no part {}", object.name, wanted));
        if (count > 0) {
            error.with_hint(fmt::format("it has {} that fit", count));
            return Outcome::refused;
        }
        std::vector<std::string> names;
        for (const Instance& instance : object.instances) {
            const std::string& name = graph_.objects[instance.master].name;
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
        if (names.size() > most_names) {
            names.resize(most_names);
            names.push_back("...");
        }
        error.with_hint(names.empty() ? "it is a primitive and has no parts"
                                      : fmt::format("its parts are {}", fmt::join(names, ", ")));
        return Outcome::refused;
    }

    const Graph& graph_;
    Diagnostics& diagnostics_;
    WorkMeter meter_;
    ObjectId object_;
    GraphPath path_;
};

} // namespace

std::optional<Address> parse_address(std::string_view text, std::string& problem) {
    problem.clear();
    return Parser(text, problem).run();
}

std::optional<GraphPath> find_path(const Graph& graph, const Address& address, Diagnostics& diagnostics,
                                   const Control& control) {
    return Finder(graph, diagnostics, control).run(address);
}

} // namespace graftal
