#include "rov/cable.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "rov/bounds.hpp"

namespace neritic::rov {
namespace {

constexpr double kContact_n_m = 1e6;
constexpr double kCreep_m_s = 1e-3;  // slower, friction is linear in the speed
constexpr double kSmallStep_m_s = 1e-9;
constexpr std::uint32_t kMostRounds = 200;
constexpr int kMostHalvings = 40;

Mat3 outer(const Vec3& a, const Vec3& b) {
  return glm::outerProduct(a, b);
}
Mat3 across(const Vec3& along) {
  return Mat3(1.0) - outer(along, along);
}

// The gradient and curvature of (c / 3) |P u|^3.
void add_cubic(double c, const Mat3& projection, const Vec3& u, Vec3& gradient, Mat3* curvature) {
  const Vec3 p = projection * u;
  const double speed = glm::length(p);
  gradient += c * speed * p;
  if (!curvature) return;
  *curvature += c * speed * projection;
  if (speed > 0.0) *curvature += (c / speed) * outer(p, p);
}

class Solver {
 public:
  Solver(const Cable& cable, double length_m, std::span<const CableContact> contacts, double dt_s,
         CableWork& work)
      : cable_(cable),
        contacts_(contacts),
        dt_s_(dt_s),
        rest_m_(length_m / cable.segments),
        work_(work) {}

  void begin(const CableEnds& ends, std::span<const Vec3> currents,
             std::span<const CableNode> nodes) {
    const std::size_t n = cable_.segments;
    work_.segments.assign(n, {});
    work_.rows.assign(n + 1, {});
    work_.presses_n.assign(contacts_.size(), 0.0);
    auto& rows = work_.rows;
    rows[0].start = ends.top_before_ned_m;
    rows[0].velocity = (ends.top_after_ned_m - ends.top_before_ned_m) / dt_s_;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      rows[i + 1].start = nodes[i].position_ned_m;
      rows[i + 1].velocity = nodes[i].velocity_ned_m_s;
    }
    rows[n].start = ends.end_free_ned_m - dt_s_ * ends.end_free_velocity_m_s;
    rows[n].velocity = ends.end_before_velocity_m_s;
    for (std::size_t i = 0; i <= n; ++i) {
      rows[i].current = currents[i];
      // Under water, by a segment's height about the surface.
      rows[i].wet = std::clamp(0.5 + rows[i].start.z / rest_m_, 0.0, 1.0);
    }
    for (std::size_t s = 0; s < n; ++s) begin_segment(s);
    for (CableWork::Row& row : rows) row.inertial = row.mass * row.velocity;
    rows[n].mass += ends.end_mass_kg;
    rows[n].inertial += ends.end_mass_kg * ends.end_free_velocity_m_s;
    end_mass_ = ends.end_mass_kg;
    end_free_ = ends.end_free_velocity_m_s;
  }

  // Newton's method; whether it came to its end.
  bool solve(std::uint32_t& rounds, bool rubs) {
    rubs_ = rubs;
    assemble(true);
    for (std::uint32_t round = 0; round < kMostRounds; ++round, ++rounds) {
      solve_rows();
      double most = 0.0, scale = 1.0, slope = 0.0;
      for (std::size_t i = 1; i < work_.rows.size(); ++i) {
        const CableWork::Row& row = work_.rows[i];
        most = std::max(most, glm::length(row.step));
        scale = std::max(scale, glm::length(row.velocity));
        slope += glm::dot(row.gradient, row.step);
      }
      if (!std::isfinite(most)) return false;
      move(1.0);
      if (most <= kSmallStep_m_s * scale) return true;
      search(slope);
      assemble(true);
    }
    return false;
  }

  void remember_presses() {
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      work_.presses_n[c] = kContact_n_m * std::max(0.0, -gap(contacts_[c]));
  }

  double tension_n(std::size_t s) const {
    const CableWork::Segment& segment = work_.segments[s];
    const double now_m = glm::length(span(s));
    return std::max(0.0, segment.stiffness_n_m * (now_m - segment.rest_m));
  }
  Vec3 impulse() const { return end_mass_ * (work_.rows.back().velocity - end_free_); }
  std::uint32_t touching() const {
    std::uint32_t count = 0;
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (gap(contacts_[c]) < 0.0 && (c == 0 || contacts_[c].segment != contacts_[c - 1].segment))
        ++count;
    return count;
  }

 private:
  Vec3 place(std::size_t row) const {
    return work_.rows[row].start + dt_s_ * work_.rows[row].velocity;
  }
  Vec3 span(std::size_t s) const { return place(s + 1) - place(s); }

  void begin_segment(std::size_t s) {
    CableWork::Segment& segment = work_.segments[s];
    CableWork::Row &a = work_.rows[s], &b = work_.rows[s + 1];
    const Vec3 way = b.start - a.start;
    segment.before_m = glm::length(way);
    segment.along = segment.before_m > 0.0 ? way / segment.before_m : Vec3(0.0, 0.0, 1.0);
    // E A (l' - l) / l + C (l' - max(l_before, l)) / (l dt), as one spring.
    const double spring = cable_.stiffness_n / rest_m_;
    const double damper = cable_.damping_n_s / (rest_m_ * dt_s_);
    segment.stiffness_n_m = spring + damper;
    segment.rest_m =
        (spring * rest_m_ + damper * std::max(segment.before_m, rest_m_)) / segment.stiffness_n_m;
    const double half_m = 0.5 * rest_m_;
    for (CableWork::Row* row : {&a, &b}) {
      const double carried = row->wet * cable_.added_mass * cable_.water_kg_m3 * cable_.area_m2();
      row->mass += half_m * (cable_.line_kg_m() * Mat3(1.0) + carried * across(segment.along));
      const double lift =
          cable_.water_kg_m3 * cable_.area_m2() * cable_.gravity_m_s2 * (1.0 - row->wet);
      row->constant += Vec3(0.0, 0.0, half_m * (cable_.net_weight_n_m + lift));
    }
  }

  double gap(const CableContact& c) const {
    const Vec3 way = dt_s_ * ((1.0 - c.share) * work_.rows[c.segment].velocity +
                              c.share * work_.rows[c.segment + 1].velocity);
    return c.gap_m + glm::dot(c.normal, way);
  }

  // The gradient of the whole, and with curved its blocks.
  void assemble(bool curved) {
    auto& rows = work_.rows;
    for (CableWork::Row& row : rows) {
      row.gradient = row.mass * row.velocity - row.inertial - dt_s_ * row.constant;
      if (curved) row.diagonal = row.mass, row.coupling = Mat3(0.0);
    }
    for (std::size_t s = 0; s < work_.segments.size(); ++s) add_segment(s, curved);
    for (std::size_t c = 0; c < contacts_.size(); ++c) add_contact(c, curved);
  }

  void add_segment(std::size_t s, bool curved) {
    const CableWork::Segment& segment = work_.segments[s];
    CableWork::Row &a = work_.rows[s], &b = work_.rows[s + 1];
    const Vec3 way = span(s);
    const double now_m = glm::length(way);
    if (now_m > segment.rest_m && now_m > 0.0) {
      const Vec3 along = way / now_m;
      const double tension = segment.stiffness_n_m * (now_m - segment.rest_m);
      a.gradient -= dt_s_ * tension * along;
      b.gradient += dt_s_ * tension * along;
      if (curved) {
        const Mat3 block =
            dt_s_ * dt_s_ *
            (segment.stiffness_n_m * outer(along, along) + (tension / now_m) * across(along));
        a.diagonal += block;
        b.diagonal += block;
        a.coupling -= block;
      }
    }
    const double half_m = 0.5 * rest_m_;
    const double area = 0.5 * cable_.water_kg_m3 * cable_.diameter_m * half_m * dt_s_;
    const Mat3 normal = across(segment.along), tangential = outer(segment.along, segment.along);
    for (CableWork::Row* row : {&a, &b}) {
      if (row->wet == 0.0) continue;
      const Vec3 flow = row->velocity - row->current;
      Mat3* curvature = curved ? &row->diagonal : nullptr;
      add_cubic(row->wet * area * cable_.normal_drag, normal, flow, row->gradient, curvature);
      add_cubic(row->wet * area * kPi * cable_.tangential_drag, tangential, flow, row->gradient,
                curvature);
    }
  }

  void add_contact(std::size_t index, bool curved) {
    const CableContact& c = contacts_[index];
    Vec3 force(0.0);  // gradient at the point
    Mat3 block(0.0);
    const double depth_m = -gap(c);
    if (depth_m > 0.0) {
      force -= dt_s_ * kContact_n_m * depth_m * c.normal;
      block += dt_s_ * dt_s_ * kContact_n_m * outer(c.normal, c.normal);
    }
    CableWork::Row &a = work_.rows[c.segment], &b = work_.rows[c.segment + 1];
    if (rubs_ && work_.presses_n[index] > 0.0) {
      const Mat3 plane = across(c.normal);
      const Vec3 slip = plane * ((1.0 - c.share) * a.velocity + c.share * b.velocity);
      const double speed = glm::length(slip);
      const double most = dt_s_ * c.friction * work_.presses_n[index];
      if (speed <= kCreep_m_s) {
        force += (most / kCreep_m_s) * slip;
        block += (most / kCreep_m_s) * plane;
      } else {
        force += (most / speed) * slip;
        block += (most / speed) * (plane - outer(slip, slip) / (speed * speed));
      }
    }
    a.gradient += (1.0 - c.share) * force;
    b.gradient += c.share * force;
    if (!curved) return;
    a.diagonal += (1.0 - c.share) * (1.0 - c.share) * block;
    b.diagonal += c.share * c.share * block;
    a.coupling += c.share * (1.0 - c.share) * block;
  }

  // Blocks on three diagonals, from the top down and back; row 0 is given.
  void solve_rows() {
    auto& rows = work_.rows;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      rows[i].step = -rows[i].gradient;
      if (i == 1) continue;
      const Mat3 back = glm::transpose(rows[i - 1].coupling) * glm::inverse(rows[i - 1].diagonal);
      rows[i].diagonal -= back * rows[i - 1].coupling;
      rows[i].step -= back * rows[i - 1].step;
    }
    for (std::size_t i = rows.size() - 1; i >= 1; --i) {
      if (i + 1 < rows.size()) rows[i].step -= rows[i].coupling * rows[i + 1].step;
      rows[i].step = glm::inverse(rows[i].diagonal) * rows[i].step;
    }
  }

  void move(double share) {
    for (std::size_t i = 1; i < work_.rows.size(); ++i)
      work_.rows[i].velocity += share * work_.rows[i].step;
  }
  double slope() {
    assemble(false);
    double sum = 0.0;
    for (std::size_t i = 1; i < work_.rows.size(); ++i)
      sum += glm::dot(work_.rows[i].gradient, work_.rows[i].step);
    return sum;
  }

  // After the whole step: goes back along the line to where the slope is less than half. The
  // function is convex, so its slope rises along the line and changes its sign once.
  void search(double first) {
    double low = 0.0, high = 1.0, at = 1.0;
    for (int k = 0; k < kMostHalvings; ++k) {
      const double now = slope();
      if (std::abs(now) <= 0.5 * std::abs(first)) return;
      if (now > 0.0)
        high = at;
      else if (at == 1.0)
        return;  // farther on it falls still: the next round goes there
      else
        low = at;
      const double next = 0.5 * (low + high);
      move(next - at);
      at = next;
    }
  }

  const Cable& cable_;
  std::span<const CableContact> contacts_;
  double dt_s_, rest_m_;
  CableWork& work_;
  Mat3 end_mass_{0.0};
  Vec3 end_free_{0.0};
  bool rubs_ = false;
};

// u with sinh(u) / u = ratio, ratio > 1: Newton from above (Behroozi 2014, Eur. J. Phys. 35,
// 055006 has the catenary in these terms).
double catenary_parameter(double ratio) {
  double u = ratio < 3.0 ? std::sqrt(6.0 * (ratio - 1.0))
                         : std::log(2.0 * ratio) + std::log(std::log(2.0 * ratio));
  for (int i = 0; i < 60; ++i) {
    const double f = std::sinh(u) - ratio * u, slope = std::cosh(u) - ratio;
    if (!(std::abs(slope) > 0.0)) break;
    const double next = std::max(0.25 * u, u - f / slope);
    if (std::abs(next - u) <= 1e-15 * u) return next;
    u = next;
  }
  return u;
}

}  // namespace

Status check_cable(const Cable& c) {
  const Bound bounds[] = {
      {"segments", static_cast<double>(c.segments), 1.0, static_cast<double>(kMostCableSegments)},
      {"diameter_m", c.diameter_m, 1e-4, 1.0},
      {"net_weight_n_m", c.net_weight_n_m, -1e4, 1e4},
      {"stiffness_n", c.stiffness_n, 1.0, 1e9},
      {"damping_n_s", c.damping_n_s, 0.0, 1e7},
      {"normal_drag", c.normal_drag, 0.0, 10.0},
      {"tangential_drag", c.tangential_drag, 0.0, 10.0},
      {"added_mass", c.added_mass, 0.0, 10.0},
      {"water_kg_m3", c.water_kg_m3, 0.0, 2000.0},
      {"gravity_m_s2", c.gravity_m_s2, 0.0, 100.0}};
  NERITIC_TRY_STATUS(check_bounds("tether", bounds));
  if (!(c.line_kg_m() >= 1e-4))
    return refusal("tether.net_weight_n_m", fmt::format("{}", c.net_weight_n_m),
                   fmt::format("over {:.4g}, since a line without mass would have that",
                               -c.water_kg_m3 * c.area_m2() * c.gravity_m_s2));
  return {};
}

void CableWork::reserve(std::uint32_t count) {
  segments.reserve(count);
  rows.reserve(count + 1);
  presses_n.reserve(8 * std::size_t{count});
}

CablePull step_cable(const Cable& cable, double length_m, const CableEnds& ends,
                     std::span<const Vec3> currents, std::span<const CableContact> contacts,
                     double dt_s, std::span<CableNode> nodes, CableWork& work) {
  Solver solver(cable, length_m, contacts, dt_s, work);
  solver.begin(ends, currents, nodes);
  CablePull out;
  out.converged = solver.solve(out.rounds, false);
  // Friction by what presses without it; once more, by what then presses.
  for (int pass = 0; pass < 2 && !contacts.empty() && out.converged; ++pass) {
    solver.remember_presses();
    if (std::ranges::none_of(work.presses_n, [](double n) { return n > 0.0; })) break;
    out.converged = solver.solve(out.rounds, true);
  }
  const Vec3 impulse = solver.impulse();
  bool finite = std::isfinite(glm::dot(impulse, impulse));
  for (const CableWork::Row& row : work.rows)
    finite = finite && std::isfinite(glm::dot(row.velocity, row.velocity));
  if (!finite) {
    out.converged = false;
    out.end_velocity_m_s = ends.end_free_velocity_m_s;
    return out;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const CableWork::Row& row = work.rows[i + 1];
    nodes[i] = {row.start + dt_s * row.velocity, row.velocity};
  }
  out.end_velocity_m_s = work.rows.back().velocity;
  out.impulse_n_s = impulse;
  out.top_n = solver.tension_n(0);
  out.end_n = solver.tension_n(cable.segments - 1);
  for (std::size_t s = 0; s < cable.segments; ++s)
    out.most_n = std::max(out.most_n, solver.tension_n(s));
  out.touching = solver.touching();
  return out;
}

void hang_cable(const Cable& cable, double length_m, const Vec3& top, const Vec3& end,
                std::span<CableNode> nodes) {
  const Vec3 way = end - top;
  const double straight_m = glm::length(way), n = cable.segments;
  if (straight_m >= length_m * (1.0 - 1e-9)) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = {top + (static_cast<double>(i + 1) / n) * way, Vec3(0.0)};
    return;
  }
  // In the plane of both ends, y upwards, or downwards for what floats:
  // y = a cosh((x - x0) / a) + c.
  const double up = cable.net_weight_n_m < 0.0 ? 1.0 : -1.0;  // of y, along down
  Vec3 ahead(way.x, way.y, 0.0);
  double wide_m = glm::length(ahead);
  ahead = wide_m > 1e-9 * length_m ? ahead / wide_m : Vec3(1.0, 0.0, 0.0);
  // Two lines that hang beside each other would be one: a little apart.
  wide_m = std::max(wide_m, 1e-3 * length_m);
  const double rise_m = up * way.z;
  const double ratio = std::sqrt(std::max(length_m * length_m - rise_m * rise_m, 0.0)) / wide_m;
  const double u = catenary_parameter(std::max(ratio, 1.0 + 1e-12));
  const double a = 0.5 * wide_m / u;
  const double x0 =
      0.5 * wide_m - a * std::atanh(std::clamp(rise_m / length_m, -1.0 + 1e-15, 1.0 - 1e-15));
  const double s0 = a * std::sinh(-x0 / a), y0 = a * std::cosh(x0 / a);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double s = length_m * static_cast<double>(i + 1) / n + s0;  // from the lowest point
    const double x = x0 + a * std::asinh(s / a), y = std::hypot(a, s) - y0;
    nodes[i] = {top + x * ahead + Vec3(0.0, 0.0, up * y), Vec3(0.0)};
  }
}

double winch_rate_m_s(double tension_n, double wanted_n, double most_m_s) {
  const double off = tension_n / wanted_n - 1.0;
  if (std::abs(off) <= 0.1) return 0.0;
  return most_m_s * std::clamp(2.0 * (off > 0.0 ? off - 0.1 : off + 0.1), -1.0, 1.0);
}

}  // namespace neritic::rov
