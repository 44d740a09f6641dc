#pragma once

#include <cstdint>
#include <exception>

namespace eigengrain {

/// Threads used by every parallel loop of the library; 0 means one per processor.
void set_threads(int threads);
int threads();

/// Calls body(begin, end, chunk) for consecutive chunks of [0, n). Chunk boundaries depend on n and
/// chunk_size only, never on the number of threads: what is summed per chunk and then over chunks in their
/// order is the same to the bit on any number of threads. An exception leaves the loop after all chunks are
/// done; of several, that of the first chunk.
template <class Body>
void for_chunks(std::int64_t n, std::int64_t chunk_size, const Body& body) {
  const std::int64_t chunks = (n + chunk_size - 1) / chunk_size;
  std::exception_ptr failure;
  std::int64_t failed = chunks;
#pragma omp parallel for schedule(dynamic, 1) if (chunks > 1)
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
    const std::int64_t begin = chunk * chunk_size;
    const std::int64_t end = begin + chunk_size < n ? begin + chunk_size : n;
    try {
      body(begin, end, chunk);
    } catch (...) {  // OpenMP lets no exception leave the loop by itself
#pragma omp critical(eigengrain_for_chunks)
      if (chunk < failed) {
        failed = chunk;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// Loop over [0, n) whose iterations are independent of each other.
template <class Body>
void for_each_index(std::int64_t n, const Body& body) {
  for_chunks(n, 1024, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
    for (std::int64_t i = begin; i < end; ++i) body(i);
  });
}

}  // namespace eigengrain
