#include "compiler/editing/maps/map_table.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "compiler/rifs/system.h"

namespace graftal {

namespace {

/// Behind the last transform, or behind the '{' of a map without one.
Span end_of_list(const Document& document, const RifsMap& map) {
    if (!map.transforms.empty()) {
        const std::uint32_t end = map.transforms.back().span.end;
        return {0, end, end};
    }
    const std::size_t open = document.text(map.span).find('{');
    const auto place =
        static_cast<std::uint32_t>(map.span.begin + (open == std::string_view::npos ? 0 : open + 1));
    return {0, place, place};
}

std::vector<WrittenMap> maps_in(const RifsFile& tree, const Document& document, const Environment& lets) {
    std::vector<WrittenMap> maps;
    const bool several = tree.blocks.size() > 1;
    for (const RifsBlock& block : tree.blocks) {
        const std::string_view block_name = block.name.text;
        const bool collides =
            std::ranges::any_of(block.maps, [&](const RifsMap& map) { return map.name.text == block_name; });
        for (const RifsMap& map : block.maps) {
            WrittenMap written;
            const std::string own =
                map.name.text.empty() ? fmt::format("w{}", map.number) : std::string(map.name.text);
            written.name = several ? fmt::format("{}.{}", block_name, own) : own;
            written.object = several || collides ? fmt::format("{}.{}", block_name, own) : own;
            if (map.broken)
                written.why = "its text is at fault";
            else
                written.form = MapForm::of(map, lets, written.why);
            written.span = map.span;
            written.list_end = end_of_list(document, map);
            written.places = {map.name.span};
            written.row = &map;
            maps.push_back(std::move(written));
        }
    }
    return maps;
}

std::vector<WrittenMap> maps_in(const InstModule& tree, const Environment& lets) {
    std::vector<WrittenMap> maps;
    std::map<std::string, int> counts;
    for (const InstDefinition& definition : tree.definitions)
        for (const InstGroup& group : definition.groups) {
            if (group.masters.empty()) continue;
            WrittenMap written;
            const std::string name = fmt::format("{}/{}", definition.name, group.masters.front().name);
            const int count = ++counts[name];
            written.name = count == 1 ? name : fmt::format("{}#{}", name, count);
            written.object = definition.name;
            written.span = group.span;
            std::uint32_t end = group.span.end;
            for (const TransformLine& line : group.transforms) {
                written.span = join(written.span, line.span);
                end = std::max(end, line.span.end);
            }
            written.list_end = {0, end, end};
            if (group.scatter)
                written.why = "a scatter places its objects";
            else
                written.form = MapForm::of(group.transforms, lets, written.why);
            for (const InstReference& master : group.masters)
                written.places.push_back(master.span);
            written.group = &group;
            maps.push_back(std::move(written));
        }
    return maps;
}

} // namespace

std::vector<WrittenMap> written_maps(const Document& document, const Environment& lets) {
    if (document.rifs()) return maps_in(*document.rifs(), document, lets);
    if (document.inst()) return maps_in(*document.inst(), lets);
    return {};
}

} // namespace graftal
