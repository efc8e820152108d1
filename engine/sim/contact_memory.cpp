// Sizes (contact_memory.hpp).
#include "engine/sim/contact_memory.hpp"

namespace neritic::sim {

void ContactMemory::reserve(std::size_t count) {
  const auto all = [&](auto&... lists) { (lists.reserve(count), ...); };
  all(near, points, thin.seen, thin.keep, thin.group, contacts, passable, body_contacts,
      solver.rows, solver.impulses);
  solver.conjugate.reserve(count);
}

}  // namespace neritic::sim
