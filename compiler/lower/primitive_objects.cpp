#include "compiler/lower/primitive_objects.h"

#include <optional>
#include <utility>

namespace graftal {

ObjectId PrimitiveObjects::of(const Primitive& primitive) {
    for (; searched_ < graph_.objects.size(); ++searched_)
        if (const std::optional<Primitive>& known = graph_.objects[searched_].primitive)
            known_.emplace(*known, static_cast<ObjectId>(searched_));
    const auto [found, fresh] = known_.try_emplace(primitive, 0);
    if (!fresh) return found->second;
    Object object;
    object.name = name_of(primitive);
    object.primitive = primitive;
    return found->second = graph_.add(std::move(object));
}

} // namespace graftal
