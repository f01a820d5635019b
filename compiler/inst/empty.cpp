#include "compiler/inst/empty.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace graftal {

namespace {

/// A flag for each object: no instance is left once the instances of empty objects are gone, and so on. Of an
/// intersection one empty operand leaves nothing, of a difference the first one.
std::vector<bool> find_empty(const Graph& graph) {
    std::vector<std::vector<ObjectId>> users(graph.objects.size());
    std::vector<std::size_t> left(graph.objects.size());
    std::vector<bool> empty(graph.objects.size());
    std::vector<ObjectId> open;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const Object& object = graph.objects[id];
        left[id] = object.instances.size();
        if (object.combination == Combination::subtract) {
            users[object.instances.front().master].push_back(id);
            left[id] = 1;
        } else {
            for (const Instance& instance : object.instances)
                users[instance.master].push_back(id);
        }
        if (object.combination == Combination::intersect) left[id] = 1;
        if (left[id] > 0 || object.primitive || object.packed) continue;
        empty[id] = true;
        open.push_back(id);
    }
    while (!open.empty()) {
        const ObjectId id = open.back();
        open.pop_back();
        for (const ObjectId user : users[id])
            if (left[user] > 0 && --left[user] == 0) empty[user] = true, open.push_back(user);
    }
    return empty;
}

/// Keeps the places of a list where `kept` is true.
template<typename T> void keep(std::vector<T>& list, const std::vector<bool>& kept) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < list.size(); ++from) {
        if (!kept[from]) continue;
        if (to != from) list[to] = std::move(list[from]);
        ++to;
    }
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(to), list.end());
}

template<typename Row>
void renumber(std::map<ObjectId, Row>& table, const std::vector<bool>& empty,
              const std::vector<ObjectId>& numbers) {
    std::map<ObjectId, Row> renumbered;
    for (auto& [id, row] : table)
        if (!empty[id]) renumbered.emplace_hint(renumbered.end(), numbers[id], std::move(row));
    table = std::move(renumbered);
}

} // namespace

bool drop_empty(Graph& graph, HueTable& hues, InkTable& inks) {
    const std::vector<bool> empty = find_empty(graph);
    if (std::ranges::count(empty, true) == 0) return true;
    if (empty[graph.root]) return false;
    std::vector<ObjectId> numbers(graph.objects.size());
    ObjectId next = 0;
    for (ObjectId id = 0; id < graph.objects.size(); ++id)
        numbers[id] = empty[id] ? 0 : next++;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        if (empty[id]) continue;
        Object& object = graph.objects[id];
        std::vector<bool> kept;
        for (Instance& instance : object.instances) {
            kept.push_back(!empty[instance.master]);
            instance.master = numbers[instance.master];
        }
        keep(object.instances, kept);
        if (object.instances.size() == 1) object.combination = Combination::unite;
        if (object.terminal && empty[object.terminal->master])
            object.terminal.reset(), object.terminal_px = 0;
        if (object.terminal) object.terminal->master = numbers[object.terminal->master];
        if (const auto row = hues.find(id); row != hues.end()) keep(row->second.instances, kept);
        if (const auto row = inks.find(id); row != inks.end()) keep(row->second.instances, kept);
    }
    std::vector<bool> full = empty;
    full.flip();
    keep(graph.objects, full);
    graph.root = numbers[graph.root];
    renumber(hues, empty, numbers);
    renumber(inks, empty, numbers);
    return true;
}

} // namespace graftal
