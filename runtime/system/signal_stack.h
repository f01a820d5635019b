#pragma once

#include <initializer_list>

namespace graftal {

/// From now on `handler` takes these signals, of all threads. Those of the calling thread it takes on a stack
/// of its own: that of the thread may be what has run out. All handlers share this stack, so that one thread
/// alone should call this.
void handle_on_own_stack(std::initializer_list<int> signals, void (*handler)(int));

} // namespace graftal
