/* SPDX-License-Identifier: Apache-2.0 */
/* Another vendor's DDS reads our joint states: prints one line per sample,
 *   sec nanosec frame_id name=position/velocity ...
 * and ends after COUNT samples (exit code 0) or SECONDS (1).
 *   cyclone_listener DOMAIN TOPIC COUNT SECONDS
 * It stays on the loopback interface unless CYCLONEDDS_URI says otherwise. */
#include <stdio.h>
#include <stdlib.h>

#include "dds/dds.h"
#include "sensor_msgs.h"

static const char *const loopback =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/>"
    "</Interfaces></General></Domain></CycloneDDS>";

static void print_sample(const sensor_msgs_msg_dds__JointState_ *joints) {
  printf("%d %u %s", joints->header_.stamp_.sec_, joints->header_.stamp_.nanosec_,
         joints->header_.frame_id_);
  for (uint32_t i = 0; i < joints->name_._length; ++i) {
    printf(" %s=%.17g", joints->name_._buffer[i],
           i < joints->position_._length ? joints->position_._buffer[i] : 0.0);
    if (i < joints->velocity_._length) printf("/%.17g", joints->velocity_._buffer[i]);
  }
  printf("\n");
  fflush(stdout);
}

static dds_entity_t make_reader(dds_domainid_t domain, const char *name) {
  const dds_entity_t participant = dds_create_participant(domain, NULL, NULL);
  const dds_entity_t topic =
      dds_create_topic(participant, &sensor_msgs_msg_dds__JointState__desc, name, NULL, NULL);
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  return reader;
}

int main(int argc, char **argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: cyclone_listener DOMAIN TOPIC COUNT SECONDS\n");
    return 2;
  }
  setenv("CYCLONEDDS_URI", loopback, 0);
  const dds_entity_t reader = make_reader((dds_domainid_t)atoi(argv[1]), argv[2]);
  if (reader < 0) {
    fprintf(stderr, "cyclone_listener: %s\n", dds_strretcode(-reader));
    return 2;
  }
  const int wanted = atoi(argv[3]);
  const dds_time_t deadline = dds_time() + DDS_SECS(atoi(argv[4]));
  int seen = 0;
  while (seen < wanted && dds_time() < deadline) {
    void *samples[1] = {NULL};
    dds_sample_info_t info;
    if (dds_take(reader, samples, &info, 1, 1) <= 0) {
      dds_sleepfor(DDS_MSECS(5));
      continue;
    }
    if (info.valid_data) {
      print_sample(samples[0]);
      ++seen;
    }
    dds_return_loan(reader, samples, 1);
  }
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return seen == wanted ? 0 : 1;
}
