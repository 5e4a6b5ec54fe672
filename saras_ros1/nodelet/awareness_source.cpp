#include "awareness_source.hpp"

#include <cmath>
#include <cstdio>

namespace saras_ros1 {
namespace {

constexpr double kFresh_s = 0.3;
constexpr double kForever_s = 1e12;  // latched: a region stays until it is cleared
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
