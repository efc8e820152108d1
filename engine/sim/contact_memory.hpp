// Memory in which contacts are found and solved. It is kept from call to call, so that a step
// allocates only if a body touches more than any did before it. Its content means nothing between
// calls, except where a function returns a span of it. One thread at a time.
#pragma once

#include "engine/sim/contact_rows.hpp"
#include "engine/sim/manifold.hpp"
#include "engine/sim/static_world.hpp"

namespace neritic::sim {

struct SolverMemory {
  // For steps that are compared with each other: rounds go on until what they change is next to
  // nothing, where else some load may still move between contacts on one line, and soft hits too
  // are one impulse at their own time (kPreciseHit_m_s).
  bool precise = false;
  std::vector<SolverContact> rows;
  std::vector<ContactImpulse> impulses;
  Conjugate conjugate;
};

struct ContactMemory {
  // For a static world's queries.
  std::vector<std::uint32_t> near;  // things
  std::vector<TouchPoint> points;   // of one part
  ThinMemory thin;
  std::vector<Contact> contacts;
  // For a body's motion.
  std::vector<std::uint32_t> passable;  // things that it is deep in
  std::vector<BodyContact> body_contacts;
  SolverMemory solver;

  // Makes room for this many contacts.
  void reserve(std::size_t count);
};

}  // namespace neritic::sim
