/* SPDX-License-Identifier: Apache-2.0 */
/* Another vendor's DDS writes captures that were stamped in 1970, a hundred each second, until it is
 * ended: a program that is no part of any deployment. Says "matched" once somebody reads them.
 *   cyclone_talker DOMAIN TOPIC */
#include <stdio.h>

#include "armature_msgs.h"
#include "cyclone_reader.h"

int main(int argc, char **argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: cyclone_talker DOMAIN TOPIC\n");
    return 2;
  }
  const dds_entity_t participant = join_domain(argv[1]);
  const dds_entity_t topic = dds_create_topic(
      participant, &armature_msgs_msg_dds__Capture__desc, argv[2], NULL, NULL);
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  if (writer < 0) {
    fprintf(stderr, "cyclone_talker: %s\n", dds_strretcode(-writer));
    return 2;
  }
  armature_msgs_msg_dds__Capture_ capture = {0};
  capture.header_.stamp_.sec_ = 1;
  capture.header_.frame_id_ = "";
  capture.on_ = true;
  bool matched = false;
  while (dds_write(writer, &capture) >= 0) {
    dds_publication_matched_status_t status;
    if (!matched && dds_get_publication_matched_status(writer, &status) >= 0 &&
        status.current_count > 0) {
      matched = true;
      fprintf(stderr, "matched\n");
    }
    dds_sleepfor(DDS_MSECS(10));
  }
  return 1;
}
