#include "compiler/primitives/tessellate.h"

#include "compiler/primitives/primitive_cache.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Values of the meshes of all finenesses, each made once.
template<typename Value> class FinenessCache {
  public:
    template<typename Make>
    const Value& get(const Primitive& primitive, int fineness, const Make& make_value) {
        GRAFTAL_CHECK(fineness >= 0 && fineness <= max_fineness(primitive), "tessellate: no such fineness");
        return by_fineness_[static_cast<std::size_t>(fineness)].get(
            primitive, [&] { return make_value(primitive, fineness); });
    }

  private:
    std::array<PrimitiveCache<Value>, finest_mesh + 1> by_fineness_;
};

} // namespace

int max_fineness(const Primitive& primitive) {
    GRAFTAL_CHECK(traits_of(primitive).bounded, "tessellate: a plane has no mesh");
    return traits_of(primitive).max_fineness;
}

const TessellatedPrimitive& tessellated(const Primitive& primitive, int fineness) {
    static FinenessCache<TessellatedPrimitive> meshes;
    return meshes.get(primitive, fineness, traits_of(primitive).mesh);
}

double tessellation_error(const Primitive& primitive, int fineness) {
    static FinenessCache<double> errors;
    return errors.get(primitive, fineness, traits_of(primitive).mesh_error);
}

int fineness_for(const Primitive& primitive, double tolerance) {
    const int most = max_fineness(primitive);
    int fineness = 0;
    while (fineness < most && !(tessellation_error(primitive, fineness) <= tolerance))
        ++fineness;
    return fineness;
}

} // namespace graftal
