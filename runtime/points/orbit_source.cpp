#include "runtime/points/orbit_source.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

class OrbitSource::Stream : public PointStream {
  public:
    Stream(const OrbitSource& source, std::uint64_t number, const Stopped& stopped)
        : source_(source), stopped_(stopped), random_(source.seed_, number), number_(number),
          place_(source.model_.start) {}

    bool fill(std::span<ChaosPoint> points) override {
        constexpr std::uint64_t steps_between_asking = 4096;
        while (steps_ < source_.model_.skip) {
            if (steps_ % steps_between_asking == 0 && stopped_ && stopped_()) return false;
            if (!step()) return false;
        }
        for (ChaosPoint& point : points) {
            if (!step()) return false;
            Rgb base = base_;
            Paint paint = paint_;
            point.place = place_;
            if (const auto& last = source_.model_.last) {
                const std::optional<Vec3> shown = mapped(*last, source_.model_.maps.size());
                if (!shown && !restarts()) return false;
                point.place = shown ? *shown : random_place();
                look(*last, paint, base);
            }
            for (int k = 0; k < 3; ++k)
                point.rgb[k] =
                    paint.fixed[static_cast<std::size_t>(k)] + paint.open * static_cast<float>(base[k]);
            point.map = static_cast<std::uint32_t>(map_ + 1);
        }
        return true;
    }

    double astray() const { return static_cast<double>(astray_) / static_cast<double>(moves_); }

  private:
    /// Begins again where a map leads astray, as flam3 does: the map after it is chosen as if there had been
    /// none, and after five in sequence the point counts where it is.
    bool step() {
        constexpr int most_astray = 5; // MOST_ASTRAY of the kernel
        const std::size_t state = steps_ > 0 && source_.choices_.size() > 1 ? map_ + 1 : 0;
        ++steps_;
        for (int attempt = 1;; ++attempt) {
            map_ = source_.single() ? 0 : source_.tables_.choose(source_.choices_[state], random_.bits());
            const OrbitFormulas& map = source_.model_.maps[map_];
            const std::optional<Vec3> next = mapped(map, map_);
            if (!next && !restarts()) return false;
            ++moves_;
            astray_ += next ? 0 : 1;
            place_ = next ? *next : random_place();
            look(map, paint_, base_);
            if (next || attempt == most_astray) return true;
        }
    }

    bool restarts() const { return source_.model_.restart > 0; }

    Vec3 random_place() {
        const double far = source_.model_.restart, x = random_.unit(), y = random_.unit();
        return {far * (2 * x - 1), far * (2 * y - 1), 0};
    }

    /// The image of the point; nothing where it goes astray, and a note where nothing goes on then.
    std::optional<Vec3> mapped(const OrbitFormulas& map, std::size_t number) {
        draws_.resize(map.all_draws);
        for (double& draw : draws_)
            draw = random_.unit();
        const std::optional<Vec3> image = apply(map, place_, draws_, slots_);
        if (image && near(*image)) return image;
        if (!restarts()) source_.note({number_, steps_, number, place_, image.has_value(), draws_});
        return std::nullopt;
    }

    void look(const OrbitFormulas& map, Paint& paint, Rgb& base) const {
        if (map.tint.alpha > 0) paint = paint.under(Paint(PathTint(map.tint)));
        if (map.material) base = source_.model_.scene.materials[*map.material].rgb;
    }

    static bool near(Vec3 p) {
        return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= farthest_of_orbit;
    }

    const OrbitSource& source_;
    Stopped stopped_;
    RandomStream random_;
    std::uint64_t number_;
    Vec3 place_;
    Paint paint_;
    Rgb base_ = Material{}.rgb;
    std::size_t map_ = 0;
    std::uint64_t steps_ = 0, moves_ = 0, astray_ = 0;
    std::vector<double> draws_, slots_;
};

OrbitSource::OrbitSource(const OrbitModel& model, std::uint64_t seed) : model_(model), seed_(seed) {
    std::vector<double> weights;
    for (const OrbitFormulas& map : model.maps)
        weights.push_back(map.probability);
    choices_.push_back(tables_.add(weights));
    for (std::size_t row = 0; row * weights.size() < model.follow.size(); ++row) {
        std::vector<double> after = weights;
        for (std::size_t i = 0; i < after.size(); ++i)
            after[i] *= model.follow[row * weights.size() + i];
        choices_.push_back(tables_.add(after));
    }
}

std::unique_ptr<PointStream> OrbitSource::stream(std::uint64_t number, const Stopped& stopped) const {
    return std::make_unique<Stream>(*this, number, stopped);
}

OrbitSource::Survey OrbitSource::survey(std::uint64_t points, const Stopped& stopped) const {
    Survey survey;
    Stream first(*this, 0, stopped);
    std::vector<ChaosPoint> batch(512);
    for (std::uint64_t left = points; left > 0;) {
        const std::span<ChaosPoint> room(batch.data(), std::min<std::uint64_t>(batch.size(), left));
        if ((stopped && stopped()) || !first.fill(room)) return survey;
        for (const ChaosPoint& point : room)
            survey.box.include(point.place);
        left -= room.size();
        survey.astray = first.astray();
    }
    return survey;
}

void OrbitSource::note(const Astray& astray) const {
    const std::lock_guard lock(noting_);
    if (!astray_ || astray.stream < astray_->stream) astray_ = astray;
}

bool OrbitSource::report(Diagnostics& diagnostics) const {
    if (!astray_) return false;
    if (!astray_->has_value) {
        model_.report(astray_->map, astray_->before, astray_->draws, diagnostics);
        return true;
    }
    const Vec3 p = astray_->before;
    diagnostics
        .error(astray_->map < model_.maps.size() ? model_.maps[astray_->map].span : model_.last->span,
               fmt::format(
                   "the orbit diverges: in step {} it goes from <{}, {}{}> farther than {} from the origin",
                   astray_->steps, shortest(p.x), shortest(p.y), model_.flat ? "" : ", " + shortest(p.z),
                   shortest(farthest_of_orbit)))
        .with_hint("try another 'start' or other parameters");
    return true;
}

} // namespace graftal
