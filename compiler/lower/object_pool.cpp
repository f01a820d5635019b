#include "compiler/lower/object_pool.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

constexpr double tolerance = 1e-11;
/// Lists of up to this many primitives are written out where they are used.
constexpr std::size_t most_written_out = 2;
/// Most lists that are compared where fingerprints do not tell lists apart, as where bodies are tiny beside
/// their distances.
constexpr std::size_t most_looked_at = 256;

/// Fixed numbers in [-1, 1] that have nothing to do with each other.
double weight(std::uint64_t index) {
    return static_cast<double>(static_cast<std::int64_t>(CounterRandom(0)(index + 1))) * 0x1p-63;
}

template<typename Visit> void for_each_entry(const Affine& map, const Visit& visit) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            visit(map.linear[column][row]);
    for (int row = 0; row < 3; ++row)
        visit(map.translation[row]);
}

bool alike(const Affine& a, const Affine& b) {
    return largest_entry(a.linear - b.linear) <= tolerance * largest_entry(a.linear) &&
           largest_entry(a.translation - b.translation) <= tolerance;
}

bool alike(const Instance& a, const Instance& b) {
    return a.master == b.master && a.material == b.material && a.tint == b.tint &&
           alike(a.parent_from_child, b.parent_from_child);
}

bool alike(const Object& a, const Object& b) {
    const auto same = [](const Instance& x, const Instance& y) { return alike(x, y); };
    return a.combination == b.combination && std::ranges::equal(a.instances, b.instances, same) &&
           a.terminal.has_value() == b.terminal.has_value() &&
           (!a.terminal || alike(*a.terminal, *b.terminal));
}

std::uint64_t hash_of_looks(const std::vector<Instance>& instances) {
    std::uint64_t hash = instances.size();
    for (const Instance& instance : instances) {
        hash = mixed(hash, instance.master);
        hash = mixed(hash, instance.material ? *instance.material + 1ull : 0ull);
    }
    return hash;
}

double size_of(const std::vector<Instance>& instances) {
    double size = 0;
    for (const Instance& instance : instances)
        size = std::max({size, largest_entry(instance.parent_from_child.linear),
                         largest_entry(instance.parent_from_child.translation)});
    return size;
}

/// A weighted sum of all numbers: lists that are alike have fingerprints closer than tolerance * entries.
double fingerprint(const std::vector<Instance>& instances) {
    double sum = 0;
    std::uint64_t index = 0;
    for (const Instance& instance : instances)
        for_each_entry(instance.parent_from_child, [&](double entry) { sum += weight(index++) * entry; });
    return sum;
}

void scale_down(Instance& instance, double size) {
    instance.parent_from_child.linear /= size;
    instance.parent_from_child.translation /= size;
}

void turn_back(Instance& instance, const Mat3& frame) {
    Affine& place = instance.parent_from_child;
    place = {glm::transpose(frame) * place.linear, glm::transpose(frame) * place.translation};
}

} // namespace

std::string object_name(std::string_view symbol) {
    std::string name;
    for (const char c : symbol)
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') name += c;
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front()))) name = "module" + name;
    return name;
}

ObjectPool::ObjectPool(Graph& graph) : graph_(graph) {
    for (const PrimitiveKind kind : all_primitive_kinds)
        names_[std::string(name_of(kind))] = 1;
}

bool ObjectPool::worth_an_object(const std::vector<Instance>& instances) const {
    if (instances.size() <= 1) return false;
    return instances.size() > most_written_out ||
           std::ranges::any_of(instances, [&](const Instance& instance) {
               return !graph_.objects[instance.master].primitive;
           });
}

/// `looked`: how many objects were compared so far.
std::uint32_t ObjectPool::find(const Object& object, std::uint64_t hash, std::size_t& looked) const {
    const std::uint32_t id = ids_.find(hash, [&](std::uint32_t other) {
        return ++looked > most_looked_at || alike(graph_.objects[shared_[other]], object);
    });
    return looked > most_looked_at ? IdTable::none : id;
}

std::vector<Instance> ObjectPool::share(std::vector<Instance> instances, std::optional<Instance> terminal,
                                        std::string_view name, Span span, const Mat3& frame) {
    if (!worth_an_object(instances)) return instances;
    if (frame != Mat3(1.0)) {
        for (Instance& instance : instances)
            turn_back(instance, frame);
        if (terminal) turn_back(*terminal, frame);
    }
    const double size = size_of(instances);
    Object object;
    object.span = span;
    object.instances = std::move(instances);
    object.terminal = std::move(terminal);
    for (Instance& instance : object.instances)
        scale_down(instance, size);
    if (object.terminal) scale_down(*object.terminal, size);

    const std::uint64_t looks = hash_of_looks(object.instances);
    const double cell_size = 24 * tolerance * static_cast<double>(object.instances.size());
    const auto cell = static_cast<std::int64_t>(std::floor(fingerprint(object.instances) / cell_size));
    std::uint32_t id = IdTable::none;
    std::size_t looked = 0;
    for (const std::int64_t near : {cell, cell - 1, cell + 1})
        if (id == IdTable::none) id = find(object, mixed(looks, static_cast<std::uint64_t>(near)), looked);
    if (id == IdTable::none) {
        id = static_cast<std::uint32_t>(shared_.size());
        if (looked <= most_looked_at) ids_.add(mixed(looks, static_cast<std::uint64_t>(cell)), id);
        object.name = unique_name(name);
        object.instances.shrink_to_fit();
        bytes_ += sizeof(Object) + object.instances.size() * sizeof(Instance) + 3 * object.name.size();
        shared_.push_back(graph_.add(std::move(object)));
    }
    return {Instance{shared_[id], {size * frame, Vec3(0.0)}, Tint(), std::nullopt, span}};
}

std::string ObjectPool::unique_name(std::string_view name) {
    const unsigned before = names_[std::string(name)]++;
    if (before == 0) return std::string(name);
    const std::string numbered = fmt::format("{}_{}", name, before + 1);
    return names_[numbered]++ == 0 ? numbered : unique_name(name);
}

} // namespace graftal
