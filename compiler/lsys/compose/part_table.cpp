#include "compiler/lsys/compose/part_table.h"

#include <algorithm>
#include <utility>

namespace graftal {

void PartTable::add(ModuleId module, Stage stage, const TurtleState& start, TurtlePart part) {
    const std::uint64_t kind_hash = mixed(module, stage);
    const std::uint32_t kind =
        kind_ids_.find_or_add(kind_hash, static_cast<std::uint32_t>(kinds_.size()), [&](std::uint32_t id) {
            return kinds_[id].module == module && kinds_[id].stage == stage;
        });
    if (kind == kinds_.size()) kinds_.push_back({module, stage, {}});
    auto& reads = kinds_[kind].reads;
    if (std::ranges::find(reads, part.reads) == reads.end()) reads.push_back(part.reads);
    part_ids_.add(mixed(kind, hash(start, part.reads)), static_cast<std::uint32_t>(parts_.size()));
    limb_nodes_ += part.limb_node_count();
    vertices_ += part.vertex_count();
    parts_.push_back({kind, start, std::move(part)});
}

const TurtlePart* PartTable::find(ModuleId module, Stage stage, const TurtleState& start) const {
    const std::uint32_t kind = kind_ids_.find(mixed(module, stage), [&](std::uint32_t id) {
        return kinds_[id].module == module && kinds_[id].stage == stage;
    });
    if (kind == IdTable::none) return nullptr;
    for (const TurtleStateMask reads : kinds_[kind].reads) {
        const std::uint32_t part = part_ids_.find(mixed(kind, hash(start, reads)), [&](std::uint32_t id) {
            const KnownPart& known = parts_[id];
            return known.kind == kind && known.part.reads == reads && equal(known.start, start, reads);
        });
        if (part != IdTable::none) return &parts_[part].part;
    }
    return nullptr;
}

} // namespace graftal
