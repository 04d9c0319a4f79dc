#include "moment.h"

#include <string.h>

moment_t moment;

void moment_save(void) {
    moment.supervisor = world.supervisor;
    moment.hal = world.hal;
    moment.rules = world.rules;
    memcpy(moment.traffic, world.traffic, sizeof moment.traffic);
    memcpy(moment.store, &world.store, sizeof moment.store);
    memcpy(moment.recorder, &world.recorder, sizeof moment.recorder);
    moment.now_ms = world.now_ms;
    moment.ticked_ms = world.ticked_ms;
    moment.unsettled = world.unsettled;
}

void moment_restore(void) {
    world.supervisor = moment.supervisor;
    world.hal = moment.hal;
    world.rules = moment.rules;
    memcpy(world.traffic, moment.traffic, sizeof moment.traffic);
    memcpy(&world.store, moment.store, sizeof moment.store);
    memcpy(&world.recorder, moment.recorder, sizeof moment.recorder);
    world.now_ms = moment.now_ms;
    world.ticked_ms = moment.ticked_ms;
    world.unsettled = moment.unsettled;
}
