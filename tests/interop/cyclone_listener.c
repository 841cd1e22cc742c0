/* SPDX-License-Identifier: Apache-2.0 */
/* Another vendor's DDS reads our joint states: prints one line per sample,
 *   sec nanosec frame_id name=position/velocity ...
 * and ends after COUNT samples (exit code 0) or SECONDS (1).
 *   cyclone_listener DOMAIN TOPIC COUNT SECONDS */
#include <stdio.h>

#include "cyclone_reader.h"
#include "sensor_msgs.h"

static void print_sample(const void *sample) {
  const sensor_msgs_msg_dds__JointState_ *joints = sample;
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

int main(int argc, char **argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: cyclone_listener DOMAIN TOPIC COUNT SECONDS\n");
    return 2;
  }
  const dds_entity_t reader = make_reader(
      join_domain(argv[1]), &sensor_msgs_msg_dds__JointState__desc, argv[2], false);
  if (reader < 0) {
    fprintf(stderr, "cyclone_listener: %s\n", dds_strretcode(-reader));
    return 2;
  }
  const int wanted = atoi(argv[3]);
  const dds_time_t deadline = dds_time() + DDS_SECS(atoi(argv[4]));
  int seen = 0;
  while (seen < wanted && dds_time() < deadline) {
    if (take_one(reader, print_sample)) {
      ++seen;
    } else {
      dds_sleepfor(DDS_MSECS(5));
    }
  }
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return seen == wanted ? 0 : 1;
}
