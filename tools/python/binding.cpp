// The C++ side of the Python package `neritic` (module neritic._core): World and VectorEnv, with
// arrays that are views of their memory. The package's Python files make the interface that people
// use. A call that steps lets other Python threads run; a world belongs to one call at a time.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>

#include "engine/core/refusal.hpp"
#include "engine/net/array_ring.hpp"
#include "testbed/envs/vector_env.hpp"
#include "testbed/world/world.hpp"

namespace py = pybind11;

namespace neritic::python {
namespace {

using namespace testbed;

// An Error on its way to Python: neritic.BadInput, or neritic.Error for all else.
struct Raised {
  Error error;
};
template <class T>
T value_of(Result<T> result) {
  if (!result.ok()) throw Raised{result.error()};
  return std::move(result).value();
}
void check(const Status& status) {
  if (!status.ok()) throw Raised{status.error()};
}

// The exceptions, from the package; they live as long as the interpreter.
PyObject* error_class = nullptr;
PyObject* bad_input_class = nullptr;
// The one that Python's handlers of signals run on.
unsigned long main_thread = 0;

// One call at a time: another thread's call is refused, not interleaved.
class Busy {
 public:
  explicit Busy(std::atomic_flag& flag) : flag_(flag) {
    if (flag_.test_and_set())
      throw Raised{
          bad_input("found a call while another thread's goes on; accepted: one at a time")};
  }
  ~Busy() {
    flag_.clear();
    flag_.notify_all();
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  std::atomic_flag& flag_;
};

// A number of readings, each by its place: the newest of each stream, or those that arrived.
struct Readings {
  std::vector<Reading> all;
  std::uint64_t step = 0;
  double time_s = 0.0;
};

const Reading& at(const Readings& readings, std::size_t place) {
  if (place >= readings.all.size()) throw py::index_error("no such reading");
  return readings.all[place];
}

// Numbers `first` to `first + count` of a reading, in its memory.
py::array_t<double> values_of(py::object owner, std::size_t place, std::size_t first,
                              std::size_t count) {
  const Reading& reading = at(owner.cast<const Readings&>(), place);
  if (first + count > reading.count) throw py::index_error("no such number");
  py::array_t<double> out(py::ssize_t_cast(count), reading.values.data() + first, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

py::tuple header_of(const Reading& reading) {
  return py::make_tuple(reading.stream, reading.count, reading.sequence, reading.stamp_ns,
                        reading.arrival_ns);
}

// A source of samples, as the server's answer to "sources" has it.
py::dict source_of(const SourceInfo& source) {
  py::dict out;
  out["name"] = source.name;
  out["health"] = source.health;
  for (const auto& [name, count] : named_counts(source.counts))
    out[py::str(std::string(name))] = count;
  if (!source.link) return out;
  const SourceInfo::Link& link = *source.link;
  py::dict of;
  of["device"] = link.device;
  of["where"] = link.where;
  of["rate_hz"] = link.rate_hz;
  of["lost"] = link.lost;
  of["clock_offset_s"] = link.clock_offset_s;
  of["clock_drift_ppm"] = link.clock_drift_ppm;
  of["jitter_ms"] = link.jitter_ms;
  of["trouble"] = link.trouble;
  out["link"] = of;
  return out;
}

// The pixels where they lie: the array keeps the image, whose memory this is, alive.
py::array pixels_of(py::object owner) {
  const auto& image = owner.cast<const WorldImage&>();
  std::vector<py::ssize_t> shape{image.height, image.width};
  if (image.channels > 1) shape.push_back(image.channels);
  return std::visit(
      [&](const auto& data) -> py::array {
        using T = typename std::decay_t<decltype(data)>::value_type;
        return py::array_t<T>(shape, data.data(), owner);
      },
      image.pixels);
}

// A server's memory of arrays. Whoever opens one must call forking() before the process forks.
using Ring = net::ArrayRingReader;

// An array of a ring in its place: the server leaves it alone until nobody has the array any more.
// None: it was overwritten, or much is lent.
py::object lend(py::object owner, std::uint64_t position, const std::vector<py::ssize_t>& shape,
                const py::dtype& type) {
  struct Lent {
    py::object owner;
    Ring::Loan loan;
    ~Lent() { owner.cast<Ring&>().give_back(loan); }
  };
  auto size = static_cast<std::size_t>(type.itemsize());
  for (const py::ssize_t length : shape)
    if (length < 0 || __builtin_mul_overflow(size, static_cast<std::size_t>(length), &size))
      return py::none();
  const std::optional<Ring::Loan> loan = owner.cast<Ring&>().lend(position, size);
  if (!loan) return py::none();
  const py::capsule base(new Lent{owner, *loan}, [](void* p) { delete static_cast<Lent*>(p); });
  return py::array(type, shape, loan->bytes.data(), base);
}

bool read(const Ring& ring, std::uint64_t position, py::array_t<std::uint8_t>& to) {
  const auto size = static_cast<std::size_t>(to.size());
  return ring.read(position, {reinterpret_cast<std::byte*>(to.mutable_data()), size});
}

struct PyWorld {
  std::unique_ptr<World> world;
  std::atomic_flag busy = ATOMIC_FLAG_INIT;
  std::atomic<unsigned long> caller{0};  // the thread whose call goes on; 0: none
  std::atomic<bool> stop{false};         // a tick that goes on ends after its step

  World& get() const {
    if (!world) throw Raised{bad_input("found a world that is closed; accepted: neritic.open()")};
    return *world;
  }
};

template <class Call>
auto with(PyWorld& self, const Call& call) {
  const Busy busy(self.busy);
  struct Caller {
    std::atomic<unsigned long>& thread;
    ~Caller() { thread = 0; }
  } caller{self.caller};
  caller.thread = PyThread_get_thread_ident();
  return call(self.get());
}

// Ends early where the readings that wait are many: its caller takes them and goes on. Between
// steps Python's handlers of signals run, so that Ctrl-C ends it: the world stays where it is.
Readings tick(PyWorld& self, std::uint64_t steps) {
  const bool handles = PyThread_get_thread_ident() == main_thread;
  constexpr auto kSignals = std::chrono::milliseconds(20);
  return with(self, [&](World& world) {
    bool raised = false;
    self.stop = false;
    auto next = std::chrono::steady_clock::now() + kSignals;
    const auto stop = [&] {
      if (self.stop || world.arrived() >= World::kMostKept / 2) return true;
      if (!handles || std::chrono::steady_clock::now() < next) return false;
      const py::gil_scoped_acquire acquire;
      raised = PyErr_CheckSignals() != 0;
      next = std::chrono::steady_clock::now() + kSignals;
      return raised;
    };
    const Status status = [&] {
      const py::gil_scoped_release release;
      return world.tick(steps, stop);
    }();
    if (raised) throw py::error_already_set();
    check(status);
    if (self.stop)
      throw Raised{failure(ErrorCode::kInterrupted, "tick: stopped at step {}, before its end",
                           world.step())};
    const auto newest = world.newest();
    return Readings{{newest.begin(), newest.end()}, world.step(), world.time_s()};
  });
}

// Another thread's call ends first; a tick ends after its step.
void close(PyWorld& self) {
  if (const unsigned long caller = self.caller;
      caller != 0 && caller != PyThread_get_thread_ident()) {
    self.stop = true;
    const py::gil_scoped_release release;
    self.busy.wait(true);
  }
  const Busy busy(self.busy);
  if (!self.world) return;
  const Status recorded = self.world->recording() ? self.world->stop_recording() : Status();
  self.world.reset();
  check(recorded);
}

py::array_t<double> array_of(std::span<const double> values) {
  return py::array_t<double>(py::ssize_t_cast(values.size()), values.data());
}

py::dict truth_of(const Truth& truth) {
  py::dict out;
  out["position"] = array_of(truth.position);
  out["orientation"] = array_of(truth.orientation);
  out["linear_velocity"] = array_of(truth.linear_velocity);
  out["angular_velocity"] = array_of(truth.angular_velocity);
  out["current"] = array_of(truth.current);
  out["thruster_n"] = array_of(truth.thruster_n);
  out["joints"] = array_of(truth.joints);
  out["touched_steps"] = truth.touched_steps;
  return out;
}

py::list streams_of(const World& world) {
  py::list out;
  for (const StreamInfo& stream : world.streams()) {
    py::list fields;
    for (const StreamField& field : stream.fields)
      fields.append(py::make_tuple(field.name, field.count));
    const char* sorts[] = {"reading", "input", "image"};
    out.append(py::make_tuple(stream.name, stream.owner, stream.kind, stream.frame,
                              sorts[static_cast<int>(stream.sort)], fields, stream.rate_hz,
                              stream.encoding));
  }
  return out;
}

py::list agents_of(const World& world) {
  py::list out;
  for (const AgentInfo& agent : world.agents())
    out.append(py::make_tuple(agent.name, agent.kind, agent.thruster_n, agent.takes_pwm,
                              agent.has_mission, agent.modem));
  return out;
}

std::span<const double> span_of(
    const py::array_t<double, py::array::c_style | py::array::forcecast>& a) {
  return {a.data(), static_cast<std::size_t>(a.size())};
}
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

void bind_world(py::module_& m) {
  py::class_<Readings>(m, "Readings")
      .def("__len__", [](const Readings& self) { return self.all.size(); })
      .def("header", [](const Readings& self, std::size_t i) { return header_of(at(self, i)); })
      .def("number",
           [](const Readings& self, std::size_t i, std::size_t k) {
             const Reading& reading = at(self, i);
             if (k >= reading.count) throw py::index_error("no such number");
             return reading.values[k];
           })
      .def("values", &values_of)
      .def_readonly("step", &Readings::step)
      .def_readonly("time", &Readings::time_s);
  py::class_<WorldImage>(m, "Image")
      .def_readonly("stream", &WorldImage::stream)
      .def_readonly("sequence", &WorldImage::sequence)
      .def_readonly("stamp_ns", &WorldImage::stamp_ns)
      .def_readonly("arrival_ns", &WorldImage::arrival_ns)
      .def_readonly("position", &WorldImage::position)
      .def_readonly("orientation", &WorldImage::orientation)
      .def_readonly("intrinsics", &WorldImage::intrinsics)
      .def_readonly("range_m", &WorldImage::range_m)
      .def_readonly("azimuth", &WorldImage::azimuth)
      .def_readonly("elevation", &WorldImage::elevation)
      .def_property_readonly("pixels", &pixels_of);
  py::class_<Ring>(m, "Ring")
      .def(py::init([](const std::string& path) { return value_of(Ring::open(path)); }))
      .def_property_readonly("token", &Ring::token)
      .def("prepare", &Ring::prepare)
      .def("lend", &lend)
      .def("read", &read)
      .def("forking", &Ring::forking);
  py::class_<PyWorld>(m, "World")
      .def(py::init([](const std::string& path, std::optional<std::uint64_t> seed, bool real_time,
                       unsigned threads, const std::string& device, bool validation) {
        auto self = std::make_unique<PyWorld>();
        const py::gil_scoped_release release;
        self->world = value_of(World::open(path, {.seed = seed,
                                                  .real_time = real_time,
                                                  .threads = threads,
                                                  .device = device,
                                                  .validation = validation}));
        return self;
      }))
      .def("close", &close)
      .def("stop", [](PyWorld& self) { self.stop = self.caller != 0; })
      .def_property_readonly("closed", [](const PyWorld& self) { return !self.world; })
      .def_property_readonly("title", [](const PyWorld& self) { return self.get().title(); })
      .def_property_readonly("path", [](const PyWorld& self) { return self.get().path(); })
      .def_property_readonly("seed", [](const PyWorld& self) { return self.get().seed(); })
      .def_property_readonly("step_s", [](const PyWorld& self) { return self.get().step_s(); })
      .def_property_readonly("step", [](const PyWorld& self) { return self.get().step(); })
      .def_property_readonly("time", [](const PyWorld& self) { return self.get().time_s(); })
      .def_property_readonly("hash", [](const PyWorld& self) { return self.get().hash(); })
      .def_property_readonly("streams", [](const PyWorld& self) { return streams_of(self.get()); })
      .def_property_readonly("objects", [](const PyWorld& self) { return self.get().objects(); })
      .def_property_readonly("agents", [](const PyWorld& self) { return agents_of(self.get()); })
      .def_property_readonly("dropped", [](const PyWorld& self) { return self.get().dropped(); })
      .def_property_readonly("recording",
                             [](const PyWorld& self) { return self.get().recording(); })
      .def("stream",
           [](PyWorld& self, const std::string& name) { return value_of(self.get().stream(name)); })
      .def("tick", &tick)
      .def("newest",
           [](PyWorld& self) {
             return with(self, [](World& world) {
               const auto newest = world.newest();
               return Readings{{newest.begin(), newest.end()}, world.step(), world.time_s()};
             });
           })
      .def("keep", [](PyWorld& self, std::uint32_t stream,
                      bool on) { with(self, [&](World& w) { check(w.keep(stream, on)); }); })
      .def("take_arrived",
           [](PyWorld& self) {
             return with(self, [](World& world) {
               return Readings{world.take_arrived(), world.step(), world.time_s()};
             });
           })
      .def("take_images",
           [](PyWorld& self) {
             return with(self, [](World& world) {
               py::list out;
               for (auto& image : world.take_images()) out.append(py::cast(std::move(image)));
               return out;
             });
           })
      .def("set_link",
           [](PyWorld& self, std::uint32_t stream, double delay_s, double jitter_s, double loss) {
             with(self, [&](World& w) { check(w.set_link(stream, {delay_s, jitter_s, loss})); });
           })
      .def("want_image",
           [](PyWorld& self, std::uint32_t stream, double rate_hz, bool keep) {
             with(self, [&](World& w) {
               const py::gil_scoped_release release;
               check(w.want_image(stream, rate_hz, keep));
             });
           })
      .def("drop_image",
           [](PyWorld& self, std::uint32_t stream) {
             with(self, [&](World& w) { check(w.drop_image(stream)); });
           })
      .def("command",
           [](PyWorld& self, const std::string& agent, const std::string& kind,
              const Numbers& values, double hold_s, const std::string& source) {
             with(self, [&](World& w) {
               check(w.command(agent, kind, span_of(values), hold_s, source));
             });
           })
      .def("release",
           [](PyWorld& self, const std::string& agent, const std::string& source) {
             with(self, [&](World& w) { check(w.release(agent, source)); });
           })
      .def("inject",
           [](PyWorld& self, const std::string& stream, const Numbers& values,
              const std::string& source, std::optional<double> stamp_s) {
             with(self,
                  [&](World& w) { check(w.inject(stream, span_of(values), source, stamp_s)); });
           })
      .def("sources",
           [](PyWorld& self) {
             py::list out;
             for (const SourceInfo& one : with(self, [](World& w) { return w.sources(); }))
               out.append(source_of(one));
             return out;
           })
      .def("truth",
           [](PyWorld& self, const std::string& agent) {
             return with(self, [&](World& w) { return truth_of(value_of(w.truth(agent))); });
           })
      .def("save",
           [](PyWorld& self) {
             const auto bytes = with(self, [](World& w) { return w.save(); });
             return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
           })
      .def("restore",
           [](PyWorld& self, const py::bytes& bytes) {
             const std::string_view view = bytes;
             with(self, [&](World& w) {
               check(w.restore(std::as_bytes(std::span(view.data(), view.size()))));
             });
           })
      .def("record",
           [](PyWorld& self, const std::string& path) {
             with(self, [&](World& w) { check(w.record(path)); });
           })
      .def("stop_recording",
           [](PyWorld& self) { with(self, [](World& w) { check(w.stop_recording()); }); });
}

// A float32 or uint8 array of the caller, to be written in place.
template <class T>
T* rows_of(const py::object& object, std::size_t rows, std::size_t columns, const char* name) {
  if (object.is_none()) return nullptr;
  const bool fits = py::isinstance<py::array_t<T, py::array::c_style>>(object);
  auto array = py::reinterpret_borrow<py::array>(object);
  if (!fits || static_cast<std::size_t>(array.size()) != rows * columns || !array.writeable())
    throw Raised{refusal(name, "another array",
                         fmt::format("a writable, C-contiguous one of {} x {}", rows, columns))};
  return static_cast<T*>(array.mutable_data());
}

struct PyVectorEnv {
  std::unique_ptr<VectorEnv> env;
  EnvArrays arrays;
  py::dict kept;  // the arrays live as long as this
  std::atomic_flag busy = ATOMIC_FLAG_INIT;
};

Randomisation random_of(const py::dict& given) {
  Randomisation r;
  const std::pair<const char*, double*> known[] = {{"mass", &r.mass},
                                                   {"net_buoyancy_n", &r.net_buoyancy_n},
                                                   {"drag", &r.drag},
                                                   {"thrust", &r.thrust},
                                                   {"current_m_s", &r.current_m_s},
                                                   {"position_noise_m", &r.position_noise_m},
                                                   {"velocity_noise_m_s", &r.velocity_noise_m_s},
                                                   {"angle_noise_rad", &r.angle_noise_rad},
                                                   {"rate_noise_rad_s", &r.rate_noise_rad_s}};
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    const auto found = std::ranges::find_if(known, [&](const auto& k) { return name == k.first; });
    if (found == std::end(known)) {
      std::string names;
      for (const auto& k : known) names += (names.empty() ? "" : ", ") + std::string(k.first);
      throw Raised{refusal("randomise", "'" + name + "'", names)};
    }
    *found->second = value.cast<double>();
  }
  return r;
}

void bind_envs(py::module_& m) {
  py::class_<PyVectorEnv>(m, "VectorEnv")
      .def(py::init([](const std::string& task, std::size_t count, const std::string& vehicle,
                       double step_s, std::uint32_t most_steps, const std::string& method,
                       int substeps, bool thrust_table, const std::optional<py::dict>& random,
                       bool wrench, bool same_step, unsigned threads) {
        auto self = std::make_unique<PyVectorEnv>();
        self->env = value_of(
            VectorEnv::create({.task = value_of(task_of(task)),
                               .count = count,
                               .vehicle = vehicle,
                               .step_s = step_s,
                               .most_steps = most_steps,
                               .method = {value_of(env_method_of(method)), substeps, thrust_table},
                               .random = random ? random_of(*random) : Randomisation::none(),
                               .wrench = wrench,
                               .same_step_reset = same_step,
                               .threads = threads}));
        return self;
      }))
      .def_property_readonly("actions", [](const PyVectorEnv& s) { return s.env->actions(); })
      .def_property_readonly("threads", [](const PyVectorEnv& s) { return s.env->threads(); })
      .def("set_arrays",
           [](PyVectorEnv& self, const py::dict& given) {
             const std::size_t rows = self.env->count(), actions = self.env->actions();
             const auto of = [&](const char* name) -> py::object { return given[name]; };
             self.arrays = {
                 .goal = rows_of<float>(of("goal"), rows, EnvArrays::kGoal, "goal"),
                 .motion = rows_of<float>(of("motion"), rows, EnvArrays::kMotion, "motion"),
                 .action = rows_of<float>(of("action"), rows, actions, "action"),
                 .reward = rows_of<float>(of("reward"), rows, 1, "reward"),
                 .terminated = rows_of<std::uint8_t>(of("terminated"), rows, 1, "terminated"),
                 .truncated = rows_of<std::uint8_t>(of("truncated"), rows, 1, "truncated"),
                 .last_goal = rows_of<float>(of("last_goal"), rows, EnvArrays::kGoal, "last_goal"),
                 .last_motion =
                     rows_of<float>(of("last_motion"), rows, EnvArrays::kMotion, "last_motion"),
                 .last_action = rows_of<float>(of("last_action"), rows, actions, "last_action")};
             self.kept = given;
           })
      .def("reset",
           [](PyVectorEnv& self, const std::vector<std::optional<std::uint64_t>>& seeds) {
             const Busy busy(self.busy);
             const py::gil_scoped_release release;
             self.env->reset(seeds, self.arrays);
           })
      .def(
          "step",
          [](PyVectorEnv& self,
             const py::array_t<float, py::array::c_style | py::array::forcecast>& actions) {
            const Busy busy(self.busy);
            const std::size_t size = self.env->count() * self.env->actions();
            if (static_cast<std::size_t>(actions.size()) != size)
              throw Raised{refusal("actions", fmt::format("{} numbers", actions.size()),
                                   fmt::format("{} x {}", self.env->count(), self.env->actions()))};
            const std::span<const float> span(actions.data(), size);
            const py::gil_scoped_release release;
            self.env->step(span, self.arrays);
          })
      .def("truth", [](const PyVectorEnv& self) {
        py::array_t<double> out({self.env->count(), std::size_t{13}});
        self.env->truth({out.mutable_data(), static_cast<std::size_t>(out.size())});
        return out;
      });
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "The C++ side of neritic; use the package.";
  m.def("set_errors", [](const py::object& error, const py::object& bad_input) {
    error_class = py::object(error).release().ptr();
    bad_input_class = py::object(bad_input).release().ptr();
  });
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const Raised& r) {
      PyObject* kind = r.error.code == ErrorCode::kBadInput ? bad_input_class : error_class;
      PyErr_SetString(kind ? kind : PyExc_RuntimeError, r.error.message.c_str());
    }
  });
  main_thread =
      py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  m.attr("GOAL") = EnvArrays::kGoal;
  m.attr("MOTION") = EnvArrays::kMotion;
  bind_world(m);
  bind_envs(m);
}

}  // namespace neritic::python
