#include "runtime/inverse/occupancy.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "runtime/inverse/map_steps.h"

namespace graftal {

namespace {

constexpr double seconds_of_step = 6e-9; ///< a map applied to a point, with what is noted of its cell
constexpr double given_up = 1e12;        ///< the price of an attractor that nobody wants
constexpr std::size_t chain_count = 4;
constexpr double known_share = 0.2;                 ///< of the work, for search()
constexpr double last_share = 0.15;                 ///< of the work, for the finer parts of cells
constexpr double hottest = 0.007, coldest = 0.0006; ///< of the target's cells

/// Draws attractors, one point for each part of a cell, and prices the cells that differ from the target's.
class AttractorPrice {
  public:
    /// `parts`: of a cell's side, a power of two.
    AttractorPrice(const Target& target, std::uint32_t parts)
        : target_(target), parts_(parts), width_(static_cast<std::uint32_t>(target.width())),
          drawn_(static_cast<std::size_t>(target.width()) * static_cast<std::size_t>(target.height())),
          drawn_parts_(drawn_.size() * parts * parts), price_(drawn_.size()) {
        for (std::size_t cell = 0; cell < price_.size(); ++cell) {
            const std::size_t column = cell % width_, row = cell / width_;
            const Vec2 p(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
            const Vec2 away = p - target.nearest(p);
            price_[cell] = static_cast<float>(0.9 + 0.1 * std::sqrt(away.x * away.x + away.y * away.y));
        }
    }

    /// About the number of cells that only the attractor or only the target has. A cell costs a little more
    /// the farther it is from the other set, so that steps towards it pay. `most`: no price above it matters.
    double of(const PlaneMaps& maps, double most, std::uint64_t& work) {
        if (++stamp_ == 0) {
            std::fill(drawn_.begin(), drawn_.end(), std::uint16_t{0});
            std::fill(drawn_parts_.begin(), drawn_parts_.end(), std::uint16_t{0});
            stamp_ = 1;
        }
        missed_.clear();
        double price = draw(maps, most);
        work += points_.size() * maps.size() + target_.points().size() / 8;
        if (price >= given_up) return price;
        for (const Vec2 p : target_.points()) {
            const std::uint32_t cell = cell_of(p);
            if (drawn(cell)) continue;
            missed_.push_back(p);
            const bool beside =
                drawn(cell - 1) || drawn(cell + 1) || drawn(cell - width_) || drawn(cell + width_);
            price += beside ? 1 : 1.1;
        }
        return price;
    }

    /// Points of the target that the attractor lacks, where the price was told.
    const std::vector<Vec2>& missed() const { return missed_; }

  private:
    std::uint32_t cell_of(Vec2 p) const {
        return static_cast<std::uint32_t>(p.y) * width_ + static_cast<std::uint32_t>(p.x);
    }
    bool drawn(std::uint32_t cell) const { return drawn_[cell] == stamp_; }

    /// The price of the cells that only the attractor has.
    double draw(const PlaneMaps& maps, double most) {
        const double width = target_.width(), height = target_.height(), parts = parts_;
        double price = 0;
        points_.assign(1, fixed_point(maps.front()));
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Vec2 p = points_[i];
            for (const PlaneMap& map : maps) {
                const Vec2 q = map(p);
                if (!(q.x >= 0 && q.y >= 0 && q.x < width && q.y < height)) return given_up;
                std::uint16_t& part = drawn_parts_[static_cast<std::uint32_t>(q.y * parts) * width_ * parts_ +
                                                   static_cast<std::uint32_t>(q.x * parts)];
                if (part == stamp_) continue;
                part = stamp_;
                points_.push_back(q);
                const std::uint32_t cell = cell_of(q);
                if (drawn(cell)) continue;
                drawn_[cell] = stamp_;
                if (target_.inside(cell)) continue;
                price += price_[cell];
                if (price > most) return given_up;
            }
        }
        return price;
    }

    const Target& target_;
    std::uint32_t parts_, width_;
    std::vector<std::uint16_t> drawn_, drawn_parts_; ///< the number of the last drawing that had them
    std::vector<float> price_;                       ///< of cells that only the attractor has
    std::vector<Vec2> points_, missed_;
    std::uint16_t stamp_ = 0;
};

/// A system on its way, and the best that it was.
struct Chain {
    PlaneMaps maps, best_maps;
    double price = given_up, best_price = given_up;
};

class Annealing {
  public:
    Annealing(const Target& target, const SearchOptions& options, const Workers& workers,
              const CancelFlag& cancel, const std::function<void(const SearchProgress&)>& on_progress)
        : target_(target), options_(options), workers_(workers), cancel_(cancel), on_progress_(on_progress),
          steps_(target, options.rules, options.most_maps),
          cells_(static_cast<double>(target.points().size())), chains_(chain_count) {}

    FoundSystem run(const FoundSystem& known) {
        seconds_ = known.seconds;
        const std::uint32_t parts = occupancy_parts(target_);
        const Vec2 middle = target_.centre();
        begin(parts / 2, {PlaneMaps{map_of({0.5, 0.5, 0, 0}, middle, middle)}});
        cool(24, 1 - last_share, hottest * cells_, coldest * cells_);
        begin(parts, {known.maps, best().best_maps});
        cool(6, 1, coldest * cells_, coldest * cells_);
        AttractorPainter painter(target_, parts);
        painter.draw(best().best_maps);
        return {best().best_maps, painter.agreement(), seconds_};
    }

  private:
    const Chain& best() const {
        return *std::min_element(chains_.begin(), chains_.end(),
                                 [](const Chain& a, const Chain& b) { return a.best_price < b.best_price; });
    }

    /// All chains begin with the best of the systems, on cells of so many parts a side.
    void begin(std::uint32_t parts, const std::vector<PlaneMaps>& systems) {
        parts_ = parts;
        prices_.clear();
        prices_.resize(static_cast<std::size_t>(workers_.count()));
        AttractorPrice price(target_, parts);
        std::uint64_t work = 0;
        Chain first;
        for (const PlaneMaps& maps : systems)
            if (const double now = price.of(maps, given_up, work); first.maps.empty() || now < first.price)
                first = {maps, maps, now, now};
        seconds_ += static_cast<double>(work) * seconds_of_step;
        chains_.assign(chain_count, first);
    }

    /// Anneals until this share of the work is done. After each stage, the worst chain goes on from where
    /// the best one is; each still knows the best that it was.
    void cool(int stages, double until, double first_heat, double last_heat) {
        const double work = (until * options_.seconds - seconds_) / seconds_of_step / stages /
                            static_cast<double>(chains_.size());
        for (int stage = 0; stage < stages && work > 0 && !cancel_.raised(); ++stage) {
            const double heat = first_heat * std::pow(last_heat / first_heat, (stage + 0.5) / stages);
            const CounterRandom random = CounterRandom(options_.seed).sequence(++batches_);
            std::vector<std::uint64_t> costs(chains_.size());
            workers_.for_each(chains_.size(), [&](int worker, std::uint64_t number) {
                std::unique_ptr<AttractorPrice>& price = prices_[static_cast<std::size_t>(worker)];
                if (!price) price = std::make_unique<AttractorPrice>(target_, parts_);
                Draws draws(random, number);
                costs[number] = anneal(chains_[number], *price, heat, work, draws);
            });
            for (const std::uint64_t cost : costs)
                seconds_ += static_cast<double>(cost) * seconds_of_step;
            const auto cheaper = [](const Chain& a, const Chain& b) { return a.price < b.price; };
            const auto [least, most] = std::minmax_element(chains_.begin(), chains_.end(), cheaper);
            most->maps = least->maps;
            most->price = least->price;
            if (on_progress_)
                on_progress_({std::min(1.0, seconds_ / options_.seconds),
                              std::max(0.0, 1 - best().best_price / cells_), best().best_maps.size()});
        }
    }

    std::uint64_t anneal(Chain& chain, AttractorPrice& price, double heat, double most_work,
                         Draws& draws) const {
        constexpr std::uint64_t work_of_step = 50;
        std::uint64_t work = 0;
        chain.price = price.of(chain.maps, given_up, work);
        std::vector<Vec2> missed = price.missed();
        while (static_cast<double>(work) < most_work && !cancel_.raised()) {
            PlaneMaps maps = chain.maps;
            steps_.step(maps, missed, draws);
            // A step to a higher price is taken with the probability exp(-rise / heat) (Metropolis 1953).
            const double most = chain.price - heat * std::log(1 - draws.unit());
            const double now = price.of(maps, most, work);
            work += work_of_step;
            if (now > most) continue;
            chain.maps.swap(maps);
            chain.price = now;
            missed = price.missed();
            if (now < chain.best_price) {
                chain.best_price = now;
                chain.best_maps = chain.maps;
            }
        }
        return work;
    }

    const Target& target_;
    const SearchOptions& options_;
    const Workers& workers_;
    const CancelFlag& cancel_;
    const std::function<void(const SearchProgress&)>& on_progress_;
    MapSteps steps_;
    double cells_; ///< of the target
    std::vector<Chain> chains_;
    std::vector<std::unique_ptr<AttractorPrice>> prices_; ///< one a worker
    std::uint32_t parts_ = 1;
    std::uint64_t batches_ = 0;
    double seconds_ = 0; ///< of counted work
};

} // namespace

std::uint32_t occupancy_parts(const Target& target) {
    const int side = std::max(target.width(), target.height()) - 2 * target.room();
    return side > 48 ? 2 : side > 24 ? 4 : 8;
}

FoundSystem search_occupancy(const Target& target, const SearchOptions& options, const Workers& workers,
                             const CancelFlag& cancel,
                             const std::function<void(const SearchProgress&)>& on_progress) {
    SearchOptions known = options;
    known.seconds *= known_share;
    const auto share = [&](SearchProgress progress) {
        progress.fraction *= known_share;
        on_progress(progress);
    };
    const FoundSystem found =
        search(target, known, workers, cancel,
               on_progress ? std::function<void(const SearchProgress&)>(share) : nullptr);
    return Annealing(target, options, workers, cancel, on_progress).run(found);
}

} // namespace graftal
