#include "awareness_source.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace saras_ros1 {
namespace {

constexpr double kFresh_s = 0.3;
constexpr double kMapFresh_s = 3.0;     // it comes about once a second
constexpr std::size_t kMaxDots = 3000;  // of a finer map every n-th vertex is drawn
constexpr double kForever_s = 1e12;     // latched: a region stays until it is cleared
constexpr std::array<const char*, 4> kStates = {"NO CONTACT", "PROXY CONTACT", "SLAVE CONTACT", "FULL CONTACT"};

template <typename Point>
saras::Vector3 vector_of(const Point& point) {
  return {point.x, point.y, point.z};
}

saras::ShortText text_of(const CsaTeleopState& told, const CsaAdmittance* did) {
  if (told.hold) {
    saras::ShortText text("HOLD ");
    return text += std::string_view(told.reason).substr(0, told.reason.find(':'));
  }
  saras::ShortText text(told.state < kStates.size() ? kStates[told.state] : "?");
  if (did != nullptr && std::isfinite(did->desired_force_N)) {
    std::array<char, 24> force = {};
    const int size = std::snprintf(force.data(), force.size(), "  %.1f N", did->normal_force_N);
    text += std::string_view(force.data(), static_cast<std::size_t>(std::clamp(size, 0, 23)));
  }
  return text;
}

/// Offset of a float32 field; negative: it has none.
int field_offset(const sensor_msgs::PointCloud2& cloud, const char* name) {
  for (const sensor_msgs::PointField& field : cloud.fields) {
    if (field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32 &&
        field.offset + sizeof(float) <= cloud.point_step) {
      return static_cast<int>(field.offset);
    }
  }
  return -1;
}

/// Empty for a cloud without x, y, z, stiffness, or with less data than it says.
std::vector<saras::InsetDot> dots_of(const sensor_msgs::PointCloud2& cloud) {
  std::array<int, 4> offsets = {};
  const std::array<const char*, 4> names = {"x", "y", "z", "stiffness"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    offsets[i] = field_offset(cloud, names[i]);
    if (offsets[i] < 0) {
      return {};
    }
  }
  const std::size_t count = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.is_bigendian || count == 0 || cloud.data.size() / cloud.point_step < count) {
    return {};
  }
  const std::size_t every = (count + kMaxDots - 1) / kMaxDots;
  std::vector<saras::InsetDot> dots;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < count; i += every) {
    std::array<float, 4> values = {};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::size_t at = i * cloud.point_step + static_cast<std::size_t>(offsets[k]);
      std::memcpy(&values[k], cloud.data.data() + at, sizeof(float));
    }
    dots.push_back({{values[0], values[1], values[2]}, values[3]});
    if (std::isfinite(values[3])) {
      low = std::min<double>(low, values[3]);
      high = std::max<double>(high, values[3]);
    }
  }
  for (saras::InsetDot& dot : dots) {
    dot.share = (dot.share - low) / std::max(high - low, 1e-9);
  }
  return dots;
}

}  // namespace

template <typename Message>
void AwarenessSource::listen(ros::NodeHandle& handle, const std::string& topic, Newest<Message> Heard::*place) {
  const auto take = [this, place](const typename Message::ConstPtr& message) {
    heard_.change([&](Heard& heard) { heard.*place = {message, ros::SteadyTime::now()}; });
  };
  subscribers_.push_back(
      handle.subscribe<Message>(topic, 1, take, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

AwarenessSource::AwarenessSource(ros::NodeHandle& handle) {
  listen(handle, "/csa/teleop/state", &Heard::told);
  listen(handle, "/csa/slave/admittance", &Heard::did);
  listen(handle, "/csa/slave/measured_cp", &Heard::tip);
  listen(handle, "/csa/proxy/measured_cp", &Heard::proxy);
  listen(handle, "/csa/proxy/closest", &Heard::closest);
  listen(handle, "/csa/proxy/contact", &Heard::contact);
  listen(handle, "/csa/master/servo_cf", &Heard::force);
  listen(handle, "/csa/teleop/picked", &Heard::picked);
  listen(handle, "/csa/modeler/roi", &Heard::region);
  subscribers_.push_back(handle.subscribe("/csa/modeler/stiffness", 1, &AwarenessSource::on_map, this));
}

void AwarenessSource::on_map(const sensor_msgs::PointCloud2::ConstPtr& message) {
  const Map map = std::make_shared<const std::vector<saras::InsetDot>>(dots_of(*message));
  heard_.change([&](Heard& heard) {
    heard.map = map;
    heard.map_at = ros::SteadyTime::now();
  });
}

AwarenessSource::Map AwarenessSource::map() const {
  const Heard heard = heard_.read();
  const bool fresh = heard.map && (ros::SteadyTime::now() - heard.map_at).toSec() <= kMapFresh_s;
  return fresh ? heard.map : Map{};
}

bool AwarenessSource::fill(saras::AwarenessView& view) {
  const Heard heard = heard_.read();
  if (!heard.told.message) {
    return false;
  }
  const CsaTeleopState* told = heard.told.fresh(kFresh_s);
  if (told == nullptr) {
    return true;  // known stays false
  }
  view.known = true;
  view.hold = told->hold;
  view.text = text_of(*told, heard.did.fresh(kFresh_s));
  if (const auto* tip = heard.tip.fresh(kFresh_s)) {
    view.tip = vector_of(tip->pose.position);
  }
  if (const auto* proxy = heard.proxy.fresh(kFresh_s)) {
    view.proxy = vector_of(proxy->pose.position);
  }
  if (const auto* closest = heard.closest.fresh(kFresh_s)) {
    view.closest = vector_of(closest->point);
  }
  if (const auto* contact = heard.contact.fresh(kFresh_s)) {
    view.normal = vector_of(contact->direction);
  }
  if (const auto* force = heard.force.fresh(kFresh_s)) {
    view.force_N = vector_of(force->wrench.force);
  }
  if (const auto* picked = heard.picked.fresh(kForever_s)) {
    view.region_corners = static_cast<int>(std::min<std::size_t>(picked->polygon.points.size(), view.region.size()));
    for (int i = 0; i < view.region_corners; ++i) {
      view.region[static_cast<std::size_t>(i)] = vector_of(picked->polygon.points[static_cast<std::size_t>(i)]);
    }
  }
  const auto* region = heard.region.fresh(kForever_s);
  view.region_closed = region != nullptr && !region->polygon.points.empty();
  // The view stays where the model was first met, so that what moves is seen to move.
  heard_.change([&](Heard& kept) {
    if (!kept.has_center && view.closest.allFinite()) {
      kept.has_center = true;
      kept.center = view.closest;
    }
    view.center = kept.has_center ? kept.center : view.tip;
  });
  return true;
}

}  // namespace saras_ros1
