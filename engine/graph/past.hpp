// Inside engine/graph: what earlier runs of an executor may still be doing on the GPU, by mip and
// layer of each object that lives outside the frame, and by byte of the transient heaps. It gives a
// run the barriers before its first uses. Plain data; rendering thread.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "engine/graph/epochs.hpp"

namespace neritic::graph {

class Past {
 public:
  // The barriers before the first uses of a plan that runs next; from then on what the plan leaves
  // counts as the past. objects, by resource: a number for the object behind an import, the same in
  // all runs. classes, by memory class: a number for the heap.
  void run(const Plan& plan, std::span<const std::uint64_t> objects,
           std::span<const std::uint64_t> classes, std::vector<std::vector<Barrier>>& first);

  // How one mip and layer of an object was left.
  struct Left {
    Epoch use;            // its last
    bool settled = true;  // no write since all could see the contents
  };
  // One entry per subresource of an object: mips outer, layers inner. Empty: never used.
  using State = std::vector<Left>;
  const State& object(std::uint64_t id) const;
  void set_object(std::uint64_t id, State state);
  void forget_object(std::uint64_t id) { objects_.erase(id); }
  std::size_t object_count() const { return objects_.size(); }

  // The heaps were made anew: nothing is pending on them.
  void forget_memory() { heaps_.clear(); }
  // A full barrier is recorded, so nothing is pending on anything. The layouts of histories stay
  // known.
  void settle();

 private:
  struct Segment {
    std::uint64_t begin, end, run;
    Pending left;
    // Pending since before the resource, on bytes of parts that no pass used.
    Pending untouched;
  };
  void start_object(const Plan& plan, const Part& part, State& state,
                    std::vector<std::vector<Barrier>>& first);
  // Puts the segment in the place of what was there; what earlier runs left on its bytes.
  Pending take_over(std::vector<Segment>& heap, Segment segment, bool in_part);

  std::map<std::uint64_t, State> objects_;
  std::map<std::uint64_t, std::vector<Segment>> heaps_;  // by class; segments in no order, disjoint
  std::uint64_t runs_ = 0;
  std::vector<std::uint32_t> by_first_;  // scratch
  std::vector<bool> in_part_;            // scratch: by resource, whether some of it has no use
  std::vector<Segment> pieces_;          // scratch
  std::vector<Pending> carried_;         // scratch
};

}  // namespace neritic::graph
