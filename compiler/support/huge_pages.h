#pragma once

#include <cstddef>
#include <vector>

namespace graftal {

/// Asks for large pages for memory that is about to be written for the first time: the system then clears and
/// maps 2 MiB at once, not 4 KiB, which costs more than writing. Small blocks, and systems without, are left alone.
void prefer_huge_pages(void* begin, std::size_t size_bytes);

/// Makes an empty vector's room so.
template<typename T> void reserve_huge(std::vector<T>& vector, std::size_t count) {
    if (count <= vector.capacity()) return;
    vector.reserve(count);
    prefer_huge_pages(vector.data(), count * sizeof(T));
}

} // namespace graftal
