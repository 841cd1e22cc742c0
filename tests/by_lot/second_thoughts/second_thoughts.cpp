// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_second_thoughts_parameters.hpp"
#include "test_second_thoughts_ports.hpp"

namespace armature::test::second_thoughts {

class SecondThoughts final : public Component {
 public:
  explicit SecondThoughts(Setup& setup)
      : Component{setup}, chance_{Parameters::read(setup.params()).seed}, ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time) override {
    const msg::NeedlePlan* planned = ports_.planned.latest();
    if (!planned) return;
    if (!passed_on_) {
      passed_on_ = true;
      return tell(*planned);
    }
    constexpr double kEvery_s = 3;
    if (chance_.happens(to_seconds(kPeriod) / kEvery_s))
      tell(chance_.happens(0.3) ? *planned : other(*planned));
  }

 private:
  static constexpr Duration kPeriod = seconds(0.02);

  double about(double most) { return most * (2 * chance_.share() - 1); }

  void move(msg::Point& point, double max_m) {
    point.x_(point.x_() + about(max_m));
    point.y_(point.y_() + about(max_m));
    point.z_(point.z_() + about(max_m));
  }

  msg::NeedlePlan other(msg::NeedlePlan plan) {
    switch (static_cast<int>(8 * chance_.share())) {
      case 0: move(plan.target_(), 0.005); break;
      case 1: move(plan.entry_(), 0.005); break;
      case 2: plan.target_().x_(std::numeric_limits<double>::quiet_NaN()); break;
      case 3: plan.markers_().clear(); break;
      case 4: std::ranges::reverse(plan.markers_()); break;
      case 5:
        for (msg::Point& marker : plan.markers_()) move(marker, 0.002);
        break;
      case 6: plan.forbidden_().clear(); break;
      default: std::swap(plan.entry_(), plan.target_());
    }
    return plan;
  }

  void tell(const msg::NeedlePlan& plan) {
    auto loan = ports_.plan.loan();
    *loan = plan;
    loan.publish();
  }

  Chance chance_;
  bool passed_on_ = false;
  Ports ports_;
};

}  // namespace armature::test::second_thoughts

ARMATURE_PLUGIN(armature::test::second_thoughts::SecondThoughts);
