/* SPDX-License-Identifier: Apache-2.0 */
/* What the Cyclone DDS programs of this folder have in common. */
#ifndef ARMATURE_TESTS_CYCLONE_READER_H
#define ARMATURE_TESTS_CYCLONE_READER_H

#include <stdbool.h>
#include <stdlib.h>

#include "dds/dds.h"

/* Joins DOMAIN; on the loopback interface unless CYCLONEDDS_URI says otherwise. */
static inline dds_entity_t join_domain(const char *domain) {
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" "
         "multicast=\"true\"/></Interfaces></General></Domain></CycloneDDS>",
         0);
  return dds_create_participant((dds_domainid_t)atoi(domain), NULL, NULL);
}

/* Reliable, with a long history; `latched`: also what was written before. */
static inline dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t *type,
                                       const char *name, bool latched) {
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
  if (latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  return reader;
}

/* Hands one sample to `see`; false when there was none. */
static inline bool take_one(dds_entity_t reader, void (*see)(const void *sample)) {
  void *samples[1] = {NULL};
  dds_sample_info_t info;
  if (dds_take(reader, samples, &info, 1, 1) <= 0) return false;
  if (info.valid_data) see(samples[0]);
  dds_return_loan(reader, samples, 1);
  return info.valid_data;
}

#endif
