// A saved state as bytes, to be kept outside the process and read back on any machine.
//
//     offset  size  content
//     0       8     "FRICTION"
//     8       4     version of this layout
//     12      4     size of all the bytes
//     16      38    guid of the FMU
//     54            the variables in the order of modelDescription.xml: Real 8 bytes, Enumeration 4
//                   the members of MEMBERS, in their order: Real 8 bytes, any other 4
//     end - 8 8     FNV-1a hash of all the bytes before it
//
// Numbers are little-endian whatever the machine: integers in two's complement, doubles in IEEE 754. There
// are no pointers and no padding, so equal states give equal bytes. The hash is changed by every change of a
// single byte: each step of it is one-to-one.
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "fmi2/log.h"
#include "fmi2/saved_state.h"
#include "fmi2/variables.h"

// Counted from 1. It increases with every change of the layout above, except of the variables, whose change
// alters the guid.
enum { LAYOUT_VERSION = 6 };

// Bytes of the parts above: the length of magic, of a guid in braces, of a 64-bit hash.
enum { MAGIC_SIZE = 8, GUID_SIZE = 38, HEADER_SIZE = MAGIC_SIZE + 4 + 4 + GUID_SIZE, HASH_SIZE = 8 };

static const char magic[MAGIC_SIZE + 1] = "FRICTION";

// What a state holds besides the variables: neighbours of one kind in a row.
typedef enum { REAL, INTEGER, FLAG } Kind;
typedef struct {
    size_t offset;
    Kind kind;
    int count;
    const char* part; // of the state, for a message
} Member;

// The parts, as messages name them.
#define OF_TIME "the time or a rate of an input"
#define OF_LAST_STEP "what the last step left"
#define OF_MODEL_EXCHANGE "what model exchange keeps"
#define OF_INSTANCE "the state of the instance"

#define AT(member) offsetof(FcSavedState, member)
static const Member MEMBERS[] = {
    {AT(friction.time), REAL, 4 + 2 * FC_INPUT_COUNT, OF_TIME},
    {AT(friction.next_rate_set), FLAG, 1, OF_TIME},
    {AT(friction.slips), INTEGER, 1, OF_LAST_STEP},
    {AT(friction.past), REAL, sizeof(FcPast) / sizeof(double), OF_LAST_STEP},
    {AT(friction.hybrid.regime), INTEGER, 1, OF_MODEL_EXCHANGE},
    {AT(friction.hybrid.changed), FLAG, 1, OF_MODEL_EXCHANGE},
    {AT(friction.hybrid.seen_time), REAL, 6 + 2 * FC_INPUT_COUNT, OF_MODEL_EXCHANGE},
    {AT(experiment.interface), INTEGER, 2, OF_INSTANCE},
    {AT(experiment.outputs_stale), FLAG, 3, OF_INSTANCE},
    {AT(experiment.start_time), REAL, 2, OF_INSTANCE},
};
enum { MEMBER_COUNT = sizeof MEMBERS / sizeof *MEMBERS };

_Static_assert(sizeof(FcHybrid) == 2 * sizeof(int) + (6 + 2 * FC_INPUT_COUNT) * sizeof(double),
               "a new member of FcHybrid must be added to MEMBERS");
_Static_assert(sizeof(FcFrictionState) == sizeof(FcVariables) + (4 + 2 * FC_INPUT_COUNT) * sizeof(double) +
                                              2 * sizeof(int) + sizeof(FcPast) + sizeof(FcHybrid),
               "a new member of FcFrictionState must be added to MEMBERS");
_Static_assert(sizeof(FcExperiment) == 6 * sizeof(int) + 2 * sizeof(double),
               "a new member of FcExperiment must be added to MEMBERS");

static uint64_t fnv1a(const unsigned char* bytes, size_t size) {
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

// One function goes over the fields of a state, to measure, to write or to read it.
typedef enum { MEASURE, WRITE, READ } Direction;

typedef struct {
    Direction direction;
    unsigned char* bytes;
    size_t at;
    const char* flaw; // the first part with an impossible value
} Cursor;

// Notes whether a value of that part is possible.
static void expect(Cursor* cursor, const char* part, bool is_possible) {
    if (!is_possible && !cursor->flaw) {
        cursor->flaw = part;
    }
}

static void transfer_bits(Cursor* cursor, uint64_t* bits, size_t size) {
    if (cursor->direction == WRITE) {
        for (size_t i = 0; i < size; i++) {
            cursor->bytes[cursor->at + i] = (unsigned char)(*bits >> (8 * i));
        }
    } else if (cursor->direction == READ) {
        *bits = 0;
        for (size_t i = 0; i < size; i++) {
            *bits |= (uint64_t)cursor->bytes[cursor->at + i] << (8 * i);
        }
    }
    cursor->at += size;
}

static void transfer_integer(Cursor* cursor, int* value) {
    uint64_t bits = (uint32_t)*value;
    transfer_bits(cursor, &bits, 4);
    const uint32_t low = (uint32_t)bits;
    memcpy(value, &low, sizeof low);
}

static void transfer_real(Cursor* cursor, const char* part, double* value) {
    uint64_t bits;
    memcpy(&bits, value, sizeof bits);
    transfer_bits(cursor, &bits, 8);
    memcpy(value, &bits, sizeof bits);
    expect(cursor, part, isfinite(*value));
}

static void transfer_member(Cursor* cursor, const Member* member, FcSavedState* saved) {
    char* first = (char*)saved + member->offset;
    for (int i = 0; i < member->count; i++) {
        if (member->kind == REAL) {
            transfer_real(cursor, member->part, (double*)(void*)first + i);
        } else {
            int* value = (int*)(void*)first + i;
            transfer_integer(cursor, value);
            expect(cursor, member->part, member->kind == INTEGER || *value == 0 || *value == 1);
        }
    }
}

static bool mode_is_sound(const FcExperiment* experiment) {
    const bool is_hybrid = experiment->interface == FC_MODEL_EXCHANGE;
    switch (experiment->mode) {
    case FC_INSTANTIATED:
    case FC_INITIALIZATION_MODE:
    case FC_TERMINATED:
        return is_hybrid || experiment->interface == FC_CO_SIMULATION;
    case FC_STEP_COMPLETE:
        return experiment->interface == FC_CO_SIMULATION;
    default:
        return is_hybrid &&
               (experiment->mode == FC_EVENT_MODE || experiment->mode == FC_CONTINUOUS_TIME_MODE);
    }
}

// Only a bounded bristle slips.
static bool regime_is_sound(const FcFrictionState* state) {
    const int regime = state->hybrid.regime;
    const bool slips = regime == FC_SLIPS_FORWARD || regime == FC_SLIPS_BACK;
    return regime == FC_FREE || (slips && fc_is_bounded(&state->variables.friction));
}

static void transfer_state(Cursor* cursor, FcSavedState* saved) {
    FcFrictionState* friction = &saved->friction;
    for (unsigned vr = 0; vr < fc_variables_count; vr++) {
        const FcVariableInfo* info = &fc_variables[vr];
        if (info->type == FC_TYPE_REAL) {
            transfer_real(cursor, info->name, fc_variable_real(&friction->variables, info));
        } else {
            transfer_integer(cursor, fc_variable_integer(&friction->variables, info));
        }
        expect(cursor, info->name, fc_variable_allows(info, fc_variable_value(&friction->variables, info)));
    }
    for (int i = 0; i < MEMBER_COUNT; i++) {
        transfer_member(cursor, &MEMBERS[i], saved);
    }
    expect(cursor, OF_LAST_STEP, friction->slips >= -1 && friction->slips <= 1);
    expect(cursor, OF_MODEL_EXCHANGE, regime_is_sound(friction));
    expect(cursor, OF_INSTANCE, mode_is_sound(&saved->experiment));
}

static size_t serialized_size(void) {
    Cursor cursor = {.direction = MEASURE, .at = HEADER_SIZE};
    FcSavedState none = {0};
    transfer_state(&cursor, &none);
    return cursor.at + HASH_SIZE;
}

static void write_header(unsigned char* bytes, size_t size) {
    Cursor cursor = {.direction = WRITE, .bytes = bytes, .at = MAGIC_SIZE};
    uint64_t version = LAYOUT_VERSION;
    uint64_t whole = size;
    memcpy(bytes, magic, MAGIC_SIZE);
    transfer_bits(&cursor, &version, 4);
    transfer_bits(&cursor, &whole, 4);
    const size_t guid_length = strlen(fc_guid);
    memset(bytes + cursor.at, 0, GUID_SIZE);
    memcpy(bytes + cursor.at, fc_guid, guid_length < GUID_SIZE ? guid_length : GUID_SIZE);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t* size) {
    const FcCall call = FC_CALL_SERIALIZED_FMU_STATE_SIZE;
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance || !fc_saved_state_of(instance, call, FMUstate)) {
        return fmi2Error;
    }
    if (!size) {
        return fc_refuse(instance, call, "size is NULL");
    }
    *size = serialized_size();
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[],
                                 size_t size) {
    const FcCall call = FC_CALL_SERIALIZE_FMU_STATE;
    const FcInstance* instance = fc_instance_enter(c, call);
    const FcSavedState* saved = instance ? fc_saved_state_of(instance, call, FMUstate) : NULL;
    if (!saved) {
        return fmi2Error;
    }
    const size_t needed = serialized_size();
    if (!serializedState) {
        return fc_refuse(instance, call, "serializedState is NULL");
    }
    if (size < needed) {
        return fc_refuse(instance, call, "size = %" PRIu64 " is below the %" PRIu64 " bytes of a state",
                         (uint64_t)size, (uint64_t)needed);
    }
    unsigned char* bytes = (unsigned char*)serializedState;
    FcSavedState copy = *saved;
    Cursor cursor = {.direction = WRITE, .bytes = bytes, .at = HEADER_SIZE};
    write_header(bytes, needed);
    transfer_state(&cursor, &copy);
    uint64_t hash = fnv1a(bytes, cursor.at);
    transfer_bits(&cursor, &hash, HASH_SIZE);
    return fmi2OK;
}

// The reason why the bytes cannot be a state of this FMU; NULL if they can.
static const char* flaw_of_bytes(const unsigned char* bytes, size_t size) {
    const size_t expected = serialized_size();
    if (size < HEADER_SIZE) {
        return "the bytes are cut off";
    }
    unsigned char header[HEADER_SIZE];
    write_header(header, expected);
    if (memcmp(bytes, header, MAGIC_SIZE) != 0) {
        return "the bytes are not a state of this FMU: they do not begin with FRICTION";
    }
    if (memcmp(bytes + MAGIC_SIZE, header + MAGIC_SIZE, 4) != 0) {
        return "the bytes have another version of the layout";
    }
    if (memcmp(bytes + MAGIC_SIZE + 8, header + MAGIC_SIZE + 8, GUID_SIZE) != 0) {
        return "the bytes come from another version of the FMU: the guid differs";
    }
    if (size != expected || memcmp(bytes + MAGIC_SIZE + 4, header + MAGIC_SIZE + 4, 4) != 0) {
        return "the bytes are cut off or too many";
    }
    Cursor cursor = {.direction = READ, .bytes = (unsigned char*)bytes, .at = expected - HASH_SIZE};
    uint64_t hash;
    transfer_bits(&cursor, &hash, HASH_SIZE);
    return hash == fnv1a(bytes, expected - HASH_SIZE) ? NULL : "the bytes are damaged: the checksum differs";
}

// Outputs that are not stale were computed of values that go together.
static bool goes_together(const FcSavedState* saved, FcMessage* message) {
    if (saved->experiment.outputs_stale || saved->experiment.mode == FC_INSTANTIATED) {
        return true;
    }
    FcFrictionContact contact = {.state = saved->friction, .cvode = {NULL}};
    return fc_friction_contact_check(&contact, message);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate* FMUstate) {
    const FcCall call = FC_CALL_DESERIALIZE_FMU_STATE;
    const FcInstance* instance = fc_instance_enter(c, call);
    if (!instance) {
        return fmi2Error;
    }
    if (!serializedState) {
        return fc_refuse(instance, call, "serializedState is NULL");
    }
    unsigned char* bytes = (unsigned char*)serializedState; // only read
    const char* flaw = flaw_of_bytes(bytes, size);
    if (flaw) {
        return fc_refuse(instance, call, "%s (%" PRIu64 " bytes)", flaw, (uint64_t)size);
    }
    FcSavedState read = {.mark = FC_SAVED_STATE_MARK};
    Cursor cursor = {.direction = READ, .bytes = bytes, .at = HEADER_SIZE};
    transfer_state(&cursor, &read);
    if (cursor.flaw) {
        return fc_refuse(instance, call, "the bytes hold an impossible value of %s", cursor.flaw);
    }
    FcMessage message;
    if (!goes_together(&read, &message)) {
        return fc_refuse(instance, call, "the bytes hold values that do not go together: %s", message.text);
    }
    FcSavedState* saved = fc_saved_state_to_fill(instance, call, FMUstate);
    if (!saved) {
        return fmi2Error;
    }
    *saved = read;
    return fmi2OK;
}
