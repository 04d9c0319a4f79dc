#include "base/fault_monitor.h"

#include <string.h>

/* The transient faults, each with its timer. */
static const struct {
    uint8_t fault;
    uint8_t timer;
} events[] = {
#define AGV_FAULT(name, class, led, flags)
#define AGV_FAULT_TRANSIENT(name, class, led, flags) {AGV_FAULT_##name, AGV_TIMER_EVENT_##name},
#include "agv/fault_table.def"
#undef AGV_FAULT
#undef AGV_FAULT_TRANSIENT
};

enum { EVENTS = sizeof events / sizeof events[0] };

void agv_fault_monitor_start(agv_fault_monitor_t *monitor) {
    monitor->summary = (agv_fault_summary_t){
        .raised = AGV_FAULT_NONE, .cause = AGV_FAULT_NONE, .ai_cause = AGV_FAULT_NONE, .unresettable = AGV_FAULT_NONE};
}

void agv_fault_monitor_set(agv_fault_monitor_t *monitor, uint32_t fault, bool cause) {
    if (fault < (uint32_t)AGV_FAULT_COUNT) {
        uint32_t *const word = &monitor->active.words[fault / 32u];
        const uint32_t bit = (uint32_t)1u << (fault % 32u);
        if (((*word & bit) != 0u) != cause) {
            *word ^= bit;
            monitor->outdated = true;
        }
    }
}

void agv_fault_monitor_event(agv_fault_monitor_t *monitor, agv_timers_t *timers, uint32_t fault) {
    for (uint32_t i = 0u; i < (uint32_t)EVENTS; i++) {
        if (events[i].fault == fault) {
            agv_timer_start(timers, events[i].timer);
            agv_fault_monitor_set(monitor, fault, true);
            agv_fault_set_put(&monitor->occurred, fault, true);
            monitor->outdated = true;
            monitor->transient = true;
        }
    }
}

void agv_fault_monitor_tick(agv_fault_monitor_t *monitor, const agv_timers_t *timers) {
    bool transient = false;
    for (uint32_t i = 0u; monitor->transient && (i < (uint32_t)EVENTS); i++) {
        if (agv_timer_reached(timers, events[i].timer)) {
            agv_fault_monitor_set(monitor, events[i].fault, false);
        }
        transient = transient || agv_timer_is_within(timers, events[i].timer);
    }
    monitor->transient = transient;
}

static void keep_highest(uint8_t *rank, uint32_t fault) {
    if (fault < *rank) {
        *rank = (uint8_t)fault;
    }
}

static void sum_up(agv_fault_summary_t *summary, uint32_t fault, bool trips) {
    const uint32_t flags = agv_fault_flags(fault);
    if ((flags & AGV_FAULT_FLAG_OF_EPS) != 0u) {
        summary->eps_fault = true;
    }
    if (!trips) {
        return;
    }
    keep_highest(((flags & AGV_FAULT_FLAG_FROM_AI) != 0u) ? &summary->ai_cause : &summary->cause, fault);
    if ((flags & AGV_FAULT_FLAG_UNRESETTABLE) != 0u) {
        keep_highest(&summary->unresettable, fault);
    }
}

static void sum_up_all(agv_fault_monitor_t *monitor) {
    agv_fault_monitor_start(monitor);
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        uint32_t fault = i * 32u;
        for (uint32_t word = monitor->active.words[i]; word != 0u; word >>= 1u) {
            if ((word & 1u) != 0u) {
                sum_up(&monitor->summary, fault, agv_fault_is_in(&monitor->tripping, fault));
            }
            fault++;
        }
    }
}

static agv_fault_set_t tripping_now(const agv_fault_monitor_t *monitor, const agv_fault_set_t *trips) {
    agv_fault_set_t set = monitor->active;
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        set.words[i] &= trips->words[i];
    }
    if (monitor->ai_loss_warns) {
        agv_fault_set_put(&set, AGV_FAULT_AI_HEARTBEAT_LOST, false);
        agv_fault_set_put(&set, AGV_FAULT_AI_HEARTBEAT_STUCK, false);
    }
    return set;
}

void agv_fault_monitor_evaluate(agv_fault_monitor_t *monitor, const agv_fault_set_t *trips, bool ai_loss_warns,
                                agv_fault_changes_t *changes) {
    const bool same = !monitor->outdated && (monitor->ai_loss_warns == ai_loss_warns);
    monitor->summary.raised = AGV_FAULT_NONE;
    changes->any = !same;
    if (same) {
        return;
    }
    monitor->outdated = false;
    monitor->ai_loss_warns = ai_loss_warns;
    const agv_fault_set_t tripping = tripping_now(monitor, trips);
    agv_fault_set_t raised;
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        raised.words[i] = tripping.words[i] & (~monitor->tripping.words[i] | monitor->occurred.words[i]);
        changes->changed.words[i] =
            (monitor->active.words[i] ^ monitor->reported.words[i]) | (tripping.words[i] ^ monitor->tripping.words[i]);
    }
    changes->was_trip = monitor->tripping;
    monitor->tripping = tripping;
    monitor->reported = monitor->active;
    (void)memset(&monitor->occurred, 0, sizeof monitor->occurred);
    sum_up_all(monitor);
    monitor->summary.raised = (uint8_t)agv_fault_first(&raised);
}

void agv_fault_monitor_latch(agv_fault_monitor_t *monitor) {
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        monitor->latched.words[i] |= monitor->tripping.words[i];
    }
}

void agv_fault_monitor_latch_one(agv_fault_monitor_t *monitor, uint32_t fault) {
    if (fault < (uint32_t)AGV_FAULT_COUNT) {
        agv_fault_set_put(&monitor->latched, fault, true);
        monitor->outdated = true;
    }
}

void agv_fault_monitor_forget(agv_fault_monitor_t *monitor) {
    (void)memset(&monitor->latched, 0, sizeof monitor->latched);
}

bool agv_fault_monitor_is_active(const agv_fault_monitor_t *monitor, uint32_t fault) {
    return agv_fault_is_in(&monitor->active, fault);
}

uint32_t agv_fault_monitor_shown(const agv_fault_monitor_t *monitor) {
    agv_fault_set_t trips;
    for (uint32_t i = 0u; i < AGV_FAULT_WORDS; i++) {
        trips.words[i] = monitor->tripping.words[i] | monitor->latched.words[i];
    }
    const uint32_t trip = agv_fault_first(&trips);
    return (trip < (uint32_t)AGV_FAULT_COUNT) ? trip : agv_fault_first(&monitor->active);
}
