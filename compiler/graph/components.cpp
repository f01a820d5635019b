#include "compiler/graph/components.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr std::uint32_t unvisited = UINT32_MAX;

/// One search; `path` stands in for the call stack of the recursive algorithm (Tarjan 1972).
class Search {
  public:
    explicit Search(const Graph& graph)
        : graph_(graph), order_(graph.objects.size(), unvisited), low_(graph.objects.size(), 0) {
        found_.component_of.assign(graph.objects.size(), unvisited);
        found_.unending.assign(graph.objects.size(), false);
    }

    Components run() && {
        for (ObjectId start = 0; start < graph_.objects.size(); ++start)
            if (order_[start] == unvisited) explore(start);
        return std::move(found_);
    }

  private:
    struct Step {
        ObjectId object;
        std::size_t next_instance;
    };

    void enter(ObjectId object) {
        order_[object] = low_[object] = visited_++;
        open_.push_back(object);
        path_.push_back({object, 0});
    }

    void explore(ObjectId start) {
        enter(start);
        while (!path_.empty()) {
            Step& step = path_.back();
            const ObjectId object = step.object;
            const std::vector<Instance>& instances = graph_.objects[object].instances;
            if (step.next_instance < instances.size()) {
                const ObjectId master = instances[step.next_instance++].master;
                if (order_[master] == unvisited)
                    enter(master);
                else if (found_.component_of[master] == unvisited)
                    low_[object] = std::min(low_[object], order_[master]);
                continue;
            }
            path_.pop_back();
            if (!path_.empty()) low_[path_.back().object] = std::min(low_[path_.back().object], low_[object]);
            if (low_[object] == order_[object]) close_component(object);
        }
    }

    /// All that was opened since `head` is one component; what it leads to is closed already.
    void close_component(ObjectId head) {
        const auto first = std::find(open_.rbegin(), open_.rend(), head).base() - 1;
        std::vector<ObjectId> members(first, open_.end());
        open_.erase(first, open_.end());
        std::sort(members.begin(), members.end());

        const auto component = static_cast<std::uint32_t>(found_.members.size());
        for (const ObjectId member : members)
            found_.component_of[member] = component;
        bool cyclic = members.size() > 1;
        bool unending = false;
        for (const ObjectId member : members) {
            for (const Instance& instance : graph_.objects[member].instances) {
                cyclic = cyclic || instance.master == member;
                unending = unending || found_.unending[instance.master];
            }
        }
        for (const ObjectId member : members)
            found_.unending[member] = cyclic || unending;
        found_.cyclic.push_back(cyclic);
        found_.members.push_back(std::move(members));
    }

    const Graph& graph_;
    Components found_;
    std::vector<std::uint32_t> order_; // by object: when the search reached it
    std::vector<std::uint32_t> low_;   // by object: the earliest open object it is known to lead to
    std::vector<ObjectId> open_;       // reached, but not yet in a component
    std::vector<Step> path_;
    std::uint32_t visited_ = 0;
};

} // namespace

bool Components::any_cycle() const {
    return std::find(cyclic.begin(), cyclic.end(), true) != cyclic.end();
}

Components strong_components(const Graph& graph) {
    return Search(graph).run();
}

std::vector<bool> terminals_that_return(const Graph& graph, const Components& components) {
    std::vector<bool> returns(graph.objects.size(), false);
    Graph with_terminals;
    bool any = false;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const Object& object = graph.objects[id];
        Object& copy = with_terminals.objects.emplace_back();
        for (const Instance& instance : object.instances)
            copy.instances.emplace_back().master = instance.master;
        if (!object.terminal || components.unending[id]) continue;
        copy.instances.emplace_back().master = object.terminal->master;
        any = true;
    }
    if (!any) return returns;
    const Components joined = strong_components(with_terminals);
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const std::optional<Instance>& terminal = graph.objects[id].terminal;
        returns[id] = terminal && !components.unending[id] &&
                      joined.component_of[id] == joined.component_of[terminal->master];
    }
    return returns;
}

} // namespace graftal
