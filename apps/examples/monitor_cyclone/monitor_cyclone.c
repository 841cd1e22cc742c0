/* SPDX-License-Identifier: Apache-2.0 */
/* An external monitor of a running deployment, with another vendor's DDS: what each process consists
 * of, and twice a second how its components are.
 *   monitor_cyclone DEPLOYMENT [DOMAIN]
 * It joins the loopback interface; set CYCLONEDDS_URI for others. Ctrl-C ends it. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "armature_msgs.h"
#include "dds/dds.h"

typedef armature_msgs_msg_dds__DeploymentDescription_ description;
typedef armature_msgs_msg_dds__ComponentStates_ states;

static volatile sig_atomic_t ended = 0;

static void end(int signal) { ended = signal; }

/* Reads "<deployment>/<name>". ROS and Armature put "rt/" before every topic's name. One who comes
 * late gets what is kept for him when he asks for it (transient local), as the writer offers it. */
static dds_entity_t read_topic(dds_entity_t participant, const dds_topic_descriptor_t *type,
                               const char *deployment, const char *name, bool latched) {
  char topic_name[256];
  snprintf(topic_name, sizeof topic_name, "rt/%s/%s", deployment, name);
  const dds_entity_t topic = dds_create_topic(participant, type, topic_name, NULL, NULL);
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100); /* every process writes one */
  if (latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  return reader;
}

static void show_description(const description *told) {
  printf("%s: process %s of Armature %s, fingerprint %.12s\n", told->deployment_, told->process_,
         told->version_, told->fingerprint_);
  for (uint32_t i = 0; i < told->components_._length; ++i) {
    const armature_msgs_msg_dds__ComponentDescription_ *component = &told->components_._buffer[i];
    printf("  %s (%s)\n", component->name_, component->plugin_);
    for (uint32_t k = 0; k < component->ports_._length; ++k) {
      const armature_msgs_msg_dds__PortDescription_ *port = &component->ports_._buffer[k];
      printf("    %s %s [%s]\n", port->output_ ? "->" : "<-", port->topic_, port->type_);
    }
  }
}

static void show_states(const states *told) {
  static const char *const kStates[] = {"ok", "degraded", "fault", "stalled"};
  for (uint32_t i = 0; i < told->components_._length; ++i) {
    const armature_msgs_msg_dds__ComponentState_ *state = &told->components_._buffer[i];
    printf("%s/%s: %s", told->process_, state->component_,
           state->state_ < 4 ? kStates[state->state_] : "?");
    if (state->reason_[0] != '\0') printf(" (%s)", state->reason_);
    printf(", 99 of 100 steps within %.0f us, %llu samples dropped\n", 1e6 * state->step_.p99_,
           (unsigned long long)state->dropped_);
  }
}

/* Hands all samples that have come to `show`. */
static void take(dds_entity_t reader, void (*show)(const void *)) {
  void *samples[1] = {NULL};
  dds_sample_info_t info;
  while (dds_take(reader, samples, &info, 1, 1) > 0) {
    if (info.valid_data) show(samples[0]);
    dds_return_loan(reader, samples, 1);
  }
  fflush(stdout);
}

static void show_any_description(const void *told) { show_description(told); }
static void show_any_states(const void *told) { show_states(told); }

int main(int argc, char **argv) {
  if (argc < 2 || argc > 3) {
    fprintf(stderr, "usage: monitor_cyclone DEPLOYMENT [DOMAIN]\n");
    return 2;
  }
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" "
         "multicast=\"true\"/></Interfaces></General></Domain></CycloneDDS>",
         0);
  signal(SIGINT, end);
  signal(SIGTERM, end);
  const dds_entity_t participant =
      dds_create_participant(argc > 2 ? (dds_domainid_t)atoi(argv[2]) : 0, NULL, NULL);
  if (participant < 0) {
    fprintf(stderr, "monitor_cyclone: cannot join DDS: %s\n", dds_strretcode(-participant));
    return 1;
  }
  const dds_entity_t descriptions = read_topic(
      participant, &armature_msgs_msg_dds__DeploymentDescription__desc, argv[1], "description", true);
  const dds_entity_t all_states = read_topic(
      participant, &armature_msgs_msg_dds__ComponentStates__desc, argv[1], "component_states", false);
  const dds_entity_t news = dds_create_waitset(participant);
  for (int i = 0; i < 2; ++i) {
    const dds_entity_t reader = i == 0 ? descriptions : all_states;
    dds_waitset_attach(news, dds_create_readcondition(reader, DDS_ANY_STATE), 0);
  }
  while (!ended) {
    dds_waitset_wait(news, NULL, 0, DDS_MSECS(100));
    take(descriptions, show_any_description);
    take(all_states, show_any_states);
  }
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return 0;
}
