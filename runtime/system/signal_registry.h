#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace graftal {

/// Things to tidy up, for handlers of signals: those may look at any moment, so that nothing here locks or
/// takes memory. The number of places is fixed; handlers do not see a thing that finds none.
template<typename T, std::size_t places> class SignalRegistry {
  public:
    /// Any thread may call this. Requires that the item lives until it is forgotten.
    void note(const T* item) noexcept { exchange(nullptr, item); }

    /// Any thread may call this. An item that was not noted, or found no place, changes nothing.
    void forget(const T* item) noexcept { exchange(item, nullptr); }

    /// Calls visit(item) for each, in no certain order. For handlers, if `visit` is.
    template<typename Visit> void for_each(Visit visit) const noexcept {
        for (const Place& place : places_)
            if (const T* item = place) visit(item);
    }

  private:
    using Place = std::atomic<const T*>;
    static_assert(Place::is_always_lock_free);

    void exchange(const T* from, const T* to) noexcept {
        for (Place& place : places_) {
            const T* expected = from;
            if (place.compare_exchange_strong(expected, to)) return;
        }
    }

    std::array<Place, places> places_;
};

} // namespace graftal
