#include "compiler/lower/object_pool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace graftal {

namespace {

constexpr double tolerance = 1e-11;
/// Lists of so few primitives are written out where they are used.
constexpr std::size_t most_written_out = 2;

/// Fixed numbers in [-1, 1] that have nothing to do with each other.
double weight(std::uint64_t index) {
    std::uint64_t z = (index + 1) * 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>(static_cast<std::int64_t>(z ^ (z >> 31))) * 0x1p-63;
}

template<typename Visit> void for_each_entry(const Affine& map, const Visit& visit) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            visit(map.linear[column][row]);
    for (int row = 0; row < 3; ++row)
        visit(map.translation[row]);
}

double largest(const Mat3& linear) {
    double result = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result = std::max(result, std::abs(linear[column][row]));
    return result;
}

double largest(const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool alike(const Affine& a, const Affine& b) {
    return largest(a.linear - b.linear) <= tolerance * largest(a.linear) &&
           largest(a.translation - b.translation) <= tolerance;
}

bool alike(const Instance& a, const Instance& b) {
    return a.master == b.master && a.material == b.material && a.tint == b.tint &&
           alike(a.parent_from_child, b.parent_from_child);
}

std::uint64_t hash_of_looks(const std::vector<Instance>& instances) {
    std::uint64_t hash = instances.size();
    for (const Instance& instance : instances) {
        hash = mixed(hash, instance.master);
        hash = mixed(hash, instance.material ? *instance.material + 1ull : 0ull);
    }
    return hash;
}

} // namespace

bool ObjectPool::worth_an_object(const std::vector<Instance>& instances) const {
    if (instances.size() <= 1) return false;
    return instances.size() > most_written_out || std::ranges::any_of(instances, [&](const Instance& instance) {
               return !graph_.objects[instance.master].primitive;
           });
}

double ObjectPool::size_of(const std::vector<Instance>& instances) {
    double size = 0;
    for (const Instance& instance : instances)
        size = std::max({size, largest(instance.parent_from_child.linear),
                         largest(instance.parent_from_child.translation)});
    return size;
}

/// A weighted sum of all numbers: lists that are alike have fingerprints closer than tolerance * entries.
double ObjectPool::fingerprint(const std::vector<Instance>& instances) {
    double sum = 0;
    std::uint64_t index = 0;
    for (const Instance& instance : instances)
        for_each_entry(instance.parent_from_child, [&](double entry) { sum += weight(index++) * entry; });
    return sum;
}

std::uint32_t ObjectPool::find(const std::vector<Instance>& instances, std::uint64_t hash) const {
    return ids_.find(hash, [&](std::uint32_t id) {
        return std::ranges::equal(graph_.objects[shared_[id]].instances, instances,
                                  [](const Instance& a, const Instance& b) { return alike(a, b); });
    });
}

std::vector<Instance> ObjectPool::share(std::vector<Instance> instances, std::string_view name, Span span) {
    if (!worth_an_object(instances)) return instances;
    const double size = size_of(instances);
    for (Instance& instance : instances) {
        instance.parent_from_child.linear /= size;
        instance.parent_from_child.translation /= size;
    }
    const auto place = [&](ObjectId object) {
        return std::vector{Instance{object, Affine::scale(Vec3(size)), Tint(), std::nullopt, span}};
    };
    const std::uint64_t looks = hash_of_looks(instances);
    const double cell_size = 24 * tolerance * static_cast<double>(instances.size());
    const auto cell = static_cast<std::int64_t>(std::floor(fingerprint(instances) / cell_size));
    for (const std::int64_t near : {cell, cell - 1, cell + 1}) {
        const std::uint32_t known = find(instances, mixed(looks, static_cast<std::uint64_t>(near)));
        if (known != IdTable::none) return place(shared_[known]);
    }
    Object object;
    object.name = unique_name(name);
    object.instances = std::move(instances);
    object.span = span;
    ids_.find_or_add(mixed(looks, static_cast<std::uint64_t>(cell)), static_cast<std::uint32_t>(shared_.size()),
                     [](std::uint32_t) { return false; });
    shared_.push_back(graph_.add(std::move(object)));
    return place(shared_.back());
}

std::string ObjectPool::unique_name(std::string_view name) {
    const unsigned before = names_[std::string(name)]++;
    if (before == 0) return std::string(name);
    const std::string numbered = fmt::format("{}_{}", name, before + 1);
    return names_[numbered]++ == 0 ? numbered : unique_name(name);
}

} // namespace graftal
