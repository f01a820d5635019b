#include "compiler/analysis/counts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/analysis/decimal.h"
#include "compiler/analysis/partition.h"

namespace graftal {

namespace {

using Number = boost::multiprecision::cpp_int;

constexpr std::uint64_t max_bits = std::uint64_t{max_counted_digits} * 10 / 3;
constexpr std::uint64_t max_held_bits = std::uint64_t{1} << 31; // in all numbers held at once
constexpr std::uint64_t max_word_operations = 1'000'000'000;    // some two seconds

std::uint64_t bits(const Number& number) {
    return number == 0 ? 1 : msb(number) + 1;
}

/// A sum that gives up when numbers or effort grow past the limits.
class Budget {
  public:
    bool add(Number& sum, const Number& number, std::uint64_t times) {
        constexpr std::uint64_t words_of_overhead = 16;
        effort_ += bits(number) / 64 + bits(sum) / 64 + words_of_overhead;
        if (times == 1) {
            sum += number;
        } else {
            product_ = number * times;
            sum += product_;
        }
        return effort_ <= max_word_operations && bits(sum) <= max_bits;
    }

    std::uint64_t effort() const { return effort_; }

  private:
    std::uint64_t effort_ = 0;
    Number product_; // kept, because long numbers are costly to allocate
};

struct Times {
    ObjectId master = 0;
    std::uint64_t times = 0;
};

/// The masters of an object, each once, by number.
std::vector<Times> masters_of(const Object& object) {
    std::vector<ObjectId> masters;
    for (const Instance& instance : object.instances)
        masters.push_back(instance.master);
    std::sort(masters.begin(), masters.end());
    std::vector<Times> result;
    for (const ObjectId master : masters) {
        if (result.empty() || result.back().master != master) result.push_back({master, 0});
        ++result.back().times;
    }
    return result;
}

/// Foresees, from the effort of the first levels, what all will cost: numbers grow in proportion to the
/// level at most, so the effort is a L + b L^2.
constexpr unsigned probed_levels = 1000;
bool costs_too_much(std::uint64_t half_way, std::uint64_t whole_way, unsigned steps) {
    constexpr double probed = probed_levels;
    const double b =
        2 * (static_cast<double>(whole_way) - 2 * static_cast<double>(half_way)) / (probed * probed);
    const double a = static_cast<double>(whole_way) / probed - b * probed;
    return (a + b * steps) * steps > static_cast<double>(max_word_operations);
}

/// Masters before their users, and ending objects before unending ones, whose terminals they may be.
std::vector<ObjectId> ending_first(const Components& components) {
    std::vector<ObjectId> order;
    for (const bool unending : {false, true})
        for (const std::vector<ObjectId>& members : components.members)
            for (const ObjectId id : members)
                if (components.unending[id] == unending) order.push_back(id);
    return order;
}

/// The parts of an unending object that do not depend on the level.
struct Fixed {
    Number every_level; ///< its ending instances
    Number where_cut;
    bool operator<(const Fixed& other) const {
        return std::tie(every_level, where_cut) < std::tie(other.every_level, other.where_cut);
    }
};

class Counter {
  public:
    Counter(const Graph& graph, const Components& components) : graph_(graph), components_(components) {}

    std::optional<Number> count(unsigned steps) {
        if (!count_ending()) return std::nullopt;
        if (!components_.unending[graph_.root]) return ending_[graph_.root];
        return count_levels(steps);
    }

  private:
    /// Counts of ending objects, masters first; each number is dropped after its last use.
    bool count_ending() {
        const std::size_t n = graph_.objects.size();
        ending_.resize(n);
        fixed_.resize(n);
        std::vector<std::uint32_t> uses(n, 0);
        uses[graph_.root] = 1;
        for (const Object& object : graph_.objects) {
            for (const Instance& instance : object.instances)
                ++uses[instance.master];
            if (object.terminal) ++uses[object.terminal->master];
        }
        for (const ObjectId id : ending_first(components_)) {
            if (!(components_.unending[id] ? add_up_fixed(id) : add_up_ending(id))) return false;
            if (held_bits_ > max_held_bits) return false;
            for (const Instance& instance : graph_.objects[id].instances)
                release(uses, instance.master);
            if (graph_.objects[id].terminal) release(uses, graph_.objects[id].terminal->master);
        }
        return true;
    }

    void release(std::vector<std::uint32_t>& uses, ObjectId id) {
        if (--uses[id] > 0 || components_.unending[id]) return;
        held_bits_ -= bits(ending_[id]);
        Number().swap(ending_[id]); // assigning 0 would keep the memory
    }

    bool add_up_ending(ObjectId id) {
        const Object& object = graph_.objects[id];
        if (object.primitive) ending_[id] = 1;
        if (object.packed) ending_[id] = object.packed.size();
        for (const Times& part : masters_of(object))
            if (!budget_.add(ending_[id], ending_[part.master], part.times)) return false;
        held_bits_ += bits(ending_[id]);
        return true;
    }

    bool add_up_fixed(ObjectId id) {
        const Object& object = graph_.objects[id];
        Fixed& fixed = fixed_[id];
        bool any = false;
        for (const Times& part : masters_of(object)) {
            if (components_.unending[part.master]) continue;
            any = true;
            if (!budget_.add(fixed.every_level, ending_[part.master], part.times)) return false;
        }
        // Nothing is left of a difference without its first part: a proxy stands for it.
        const bool is_proxy = object.combination == Combination::subtract &&
                              components_.unending[object.instances.front().master];
        if (object.terminal)
            fixed.where_cut = ending_[object.terminal->master];
        else
            fixed.where_cut = any && !is_proxy ? fixed.every_level : Number(1);
        held_bits_ += bits(fixed.every_level) + bits(fixed.where_cut);
        return true;
    }

    /// Unending objects that count alike, as one.
    Partition classes() const {
        std::map<Fixed, double> numbers;
        LabelledGraph labelled;
        labelled.edges.resize(graph_.objects.size());
        for (ObjectId id = 0; id < graph_.objects.size(); ++id) {
            if (!components_.unending[id]) {
                labelled.label.push_back(-1);
                continue;
            }
            labelled.label.push_back(numbers.emplace(fixed_[id], numbers.size()).first->second);
            for (const Instance& instance : graph_.objects[id].instances)
                if (components_.unending[instance.master]) labelled.edges[id].push_back({instance.master, 0});
        }
        return group_equal_nodes(labelled);
    }

    std::optional<Number> count_levels(unsigned steps) {
        const Partition partition = classes();
        struct Class {
            const Fixed* fixed;
            std::vector<Times> parts; // by class
        };
        std::vector<Class> table;
        std::vector<Number> count;
        for (const ObjectId id : partition.representative) {
            Class row{&fixed_[id], {}};
            std::map<std::uint32_t, std::uint64_t> parts;
            for (const Instance& instance : graph_.objects[id].instances)
                if (components_.unending[instance.master]) ++parts[partition.class_of[instance.master]];
            for (const auto& [part, times] : parts)
                row.parts.push_back({part, times});
            table.push_back(std::move(row));
            count.push_back(fixed_[id].where_cut);
        }
        std::vector<Number> deeper(count.size());
        std::uint64_t half_way = 0;
        for (unsigned level = 0; level < steps; ++level) {
            for (std::size_t c = 0; c < table.size(); ++c) {
                deeper[c] = table[c].fixed->every_level;
                for (const Times& part : table[c].parts)
                    if (!budget_.add(deeper[c], count[part.master], part.times)) return std::nullopt;
            }
            std::swap(count, deeper);
            if (level == probed_levels / 2) half_way = budget_.effort();
            if (level == probed_levels && costs_too_much(half_way, budget_.effort(), steps))
                return std::nullopt;
        }
        return count[partition.class_of[graph_.root]];
    }

    const Graph& graph_;
    const Components& components_;
    std::vector<Number> ending_; // by object, while in use
    std::vector<Fixed> fixed_;   // by object, of unending ones
    std::uint64_t held_bits_ = 0;
    Budget budget_;
};

} // namespace

std::optional<std::string> count_leaves(const Graph& graph, const Components& components,
                                        std::optional<unsigned> steps) {
    if (components.unending[graph.root] && (!steps || *steps > max_counted_steps)) return std::nullopt;
    const std::optional<Number> count = Counter(graph, components).count(steps.value_or(0));
    if (!count) return std::nullopt;
    std::string digits = to_decimal(*count);
    if (digits.size() > max_counted_digits) return std::nullopt;
    return digits;
}

} // namespace graftal
