// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/conflicts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "armature/bus/topic_name.hpp"

namespace armature {
namespace {

std::string end_name(bool writes) { return writes ? "writer" : "reader"; }

bool has_other_layout(const Endpoint& other, const OwnEndpoint& own) {
  return other.tag.ours && other.tag.layout != 0 && other.type == own.topic.type->dds_name &&
         other.tag.layout != own.topic.type->layout;
}

}  // namespace

void Conflicts::own_endpoint_added(const OwnEndpoint& added, const Discovery& discovery) {
  {
    const std::scoped_lock lock{mutex_};
    endpoints_.push_back(added);
  }
  // Asked only now: whoever is found from here on finds the new endpoint among ours.
  for (const Endpoint& other : discovery.endpoints()) {
    compare(added, other, discovery);
    tell_second_writer(own_on(other.topic), other, discovery);
  }
}

void Conflicts::endpoint_found(const Endpoint& other, const Discovery& discovery) {
  const std::vector<OwnEndpoint> own = own_on(other.topic);
  for (const OwnEndpoint& endpoint : own) compare(endpoint, other, discovery);
  tell_second_writer(own, other, discovery);
}

std::vector<OwnEndpoint> Conflicts::own_on(const std::string& topic) const {
  const std::scoped_lock lock{mutex_};
  std::vector<OwnEndpoint> own;
  std::ranges::copy_if(endpoints_, std::back_inserter(own),
                       [&](const OwnEndpoint& endpoint) { return endpoint.topic.name == topic; });
  return own;
}

/// Where writer and reader are in one process nobody else is heard, and nobody is refused. That
/// somebody tries is worth a line, on the topics that are the deployment's own.
void Conflicts::tell_second_writer(const std::vector<OwnEndpoint>& own, const Endpoint& other,
                                   const Discovery& discovery) {
  const auto writes = [](const OwnEndpoint& endpoint) { return endpoint.writes; };
  if (own.empty() || !other.writes || !std::ranges::all_of(own, writes)) return;
  if (!other.topic.starts_with("rt/" + own_.deployment + "/")) return;
  if (same_deployment(other.tag, own_)) return;
  report({TransportEvent::Kind::foreign_writer, other.topic,
          "a writer of " + discovery.owner(other) + " writes '" + ros_topic_name(other.topic) +
              "', too, which is this deployment's own: nobody here hears it"});
}

bool Conflicts::refuses(const Endpoint& writer, const OwnEndpoint& reader) const {
  if (has_other_layout(writer, reader)) return true;
  return reader.same_deployment_only && !same_deployment(writer.tag, own_);
}

void Conflicts::compare(const OwnEndpoint& own, const Endpoint& other, const Discovery& discovery) {
  if (own.topic.name != other.topic) return;
  const std::string who = "a " + end_name(other.writes) + " of " + discovery.owner(other);
  const std::string own_type{own.topic.type->dds_name};
  if (other.type != own_type) {
    report({TransportEvent::Kind::type_conflict, other.topic,
            who + " uses the type " + other.type + " on '" + ros_topic_name(other.topic) +
                "', our " + end_name(own.writes) + " uses " + own_type + ": they never meet"});
    return;
  }
  if (has_other_layout(other, own)) {
    report({TransportEvent::Kind::layout_conflict, other.topic,
            who + " has another layout of " + own_type + " on '" + ros_topic_name(other.topic) +
                "' than this process: build both from the same idl/"});
    return;
  }
  if (other.writes && !own.writes && refuses(other, own)) {
    std::string theirs;
    if (other.tag.ours) {
      theirs = other.tag.fingerprint == own_.fingerprint
                   ? " (another run of this configuration)"
                   : " (configuration " + other.tag.fingerprint.substr(0, 12) + ")";
    }
    const bool commands = own.topic.qos == QosProfile::command;
    report({TransportEvent::Kind::foreign_writer, other.topic,
            who + theirs + " was refused on '" + ros_topic_name(other.topic) +
                "': " + (commands ? "commands are taken" : "this input takes samples") +
                " only from deployment '" + own_.deployment + "' (configuration " +
                own_.fingerprint.substr(0, 12) + ")" +
                (commands ? "" : "; 'open:' in its file opens an input to all")});
  }
}

void Conflicts::report(const TransportEvent& event) {
  {
    const std::scoped_lock lock{mutex_};
    const std::pair what{event.kind, event.topic + "\n" + event.text};
    if (reported_.find(what)) return;
    reported_.put(what, {});
  }
  report_always(event);
}

void Conflicts::report_always(const TransportEvent& event) const {
  if (on_event_) on_event_(event);
}

}  // namespace armature
