#include "runtime/points/orbit_source.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

class OrbitSource::Stream : public PointStream {
  public:
    Stream(const OrbitSource& source, std::uint64_t number)
        : source_(source), random_(source.seed_, number), number_(number), place_(source.model_.start) {}

    bool fill(std::span<ChaosPoint> points) override {
        while (steps_ < source_.model_.skip)
            if (!step()) return false;
        for (ChaosPoint& point : points) {
            if (!step()) return false;
            const Rgb base = base_;
            point.place = place_;
            for (int k = 0; k < 3; ++k)
                point.rgb[k] =
                    paint_.fixed[static_cast<std::size_t>(k)] + paint_.open * static_cast<float>(base[k]);
            point.map = static_cast<std::uint32_t>(map_ + 1);
        }
        return true;
    }

  private:
    bool step() {
        const OrbitModel& model = source_.model_;
        map_ = source_.single() ? 0 : source_.tables_.choose(source_.choice_, random_.bits());
        const OrbitFormulas& map = model.maps[map_];
        const std::optional<Vec3> next = apply(map, place_, slots_);
        ++steps_;
        if (!next || !near(*next)) {
            source_.note({number_, steps_, map_, place_, next.has_value()});
            return false;
        }
        place_ = *next;
        if (map.tint.alpha > 0) paint_ = paint_.under(Paint(PathTint(map.tint)));
        if (map.material) base_ = model.scene.materials[*map.material].rgb;
        return true;
    }

    static bool near(Vec3 p) {
        return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= farthest_of_orbit;
    }

    const OrbitSource& source_;
    RandomStream random_;
    std::uint64_t number_;
    Vec3 place_;
    Paint paint_;
    Rgb base_ = Material{}.rgb;
    std::size_t map_ = 0;
    std::uint64_t steps_ = 0;
    std::vector<double> slots_;
};

OrbitSource::OrbitSource(const OrbitModel& model, std::uint64_t seed) : model_(model), seed_(seed) {
    std::vector<double> weights;
    for (const OrbitFormulas& map : model.maps)
        weights.push_back(map.probability);
    choice_ = tables_.add(weights);
}

std::unique_ptr<PointStream> OrbitSource::stream(std::uint64_t number) const {
    return std::make_unique<Stream>(*this, number);
}

Box OrbitSource::survey(std::uint64_t points) const {
    Box box;
    const std::unique_ptr<PointStream> first = stream(0);
    std::vector<ChaosPoint> batch(512);
    for (std::uint64_t left = points; left > 0;) {
        const std::span<ChaosPoint> room(batch.data(), std::min<std::uint64_t>(batch.size(), left));
        if (!first->fill(room)) return box;
        for (const ChaosPoint& point : room)
            box.include(point.place);
        left -= room.size();
    }
    return box;
}

void OrbitSource::note(const Astray& astray) const {
    const std::lock_guard lock(noting_);
    if (!astray_ || astray.stream < astray_->stream) astray_ = astray;
}

bool OrbitSource::report(Diagnostics& diagnostics) const {
    if (!astray_) return false;
    if (!astray_->has_value) {
        model_.report(astray_->map, astray_->before, diagnostics);
        return true;
    }
    const Vec3 p = astray_->before;
    diagnostics
        .error(model_.maps[astray_->map].span,
               fmt::format(
                   "the orbit diverges: in step {} it goes from <{}, {}{}> farther than {} from the origin",
                   astray_->steps, shortest(p.x), shortest(p.y), model_.flat ? "" : ", " + shortest(p.z),
                   shortest(farthest_of_orbit)))
        .with_hint("try another 'start' or other parameters");
    return true;
}

} // namespace graftal
