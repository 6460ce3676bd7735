/* The native limit: the array instructions of asm/trajectory.s by hand, with vector types.
 *
 * Lanes are 32 + 32 + 16, so that 8 x 10 NPs need no padding. What the program computes alike in all
 * NPs is one number here, as in the compiled engine. Nothing is counted and nothing checked.
 */
#include <stdint.h>
#include <string.h>

enum { NPS = 80, COLS_OF_NPS = 10, WIDTH = 80, PIXELS = 64 };

typedef uint8_t v16 __attribute__((vector_size(16)));
typedef uint8_t v32 __attribute__((vector_size(32), aligned(16)));
typedef uint64_t v16w __attribute__((vector_size(16)));
typedef uint64_t v32w __attribute__((vector_size(32), aligned(16)));
typedef struct { v32 a, b; v16 c; } plane; /* 80 bytes, in order; gcc splits 64 bytes badly */

#define EACH(name, expression) \
    static inline v32 name##32(v32 x, v32 y) { return (v32)(expression); } \
    static inline v16 name##16(v16 x, v16 y) { return (v16)(expression); } \
    static inline plane name(plane x, plane y) \
    { \
        return (plane){name##32(x.a, y.a), name##32(x.b, y.b), name##16(x.c, y.c)}; \
    }
EACH(add, x + y)
EACH(sub, x - y)
EACH(and, x & y)
EACH(or, x | y)
EACH(lower, x < y)
EACH(equal, x == y)

static inline plane all(uint8_t x)
{
    return (plane){(v32){0} + x, (v32){0} + x, (v16){0} + x};
}
static inline plane not(plane x) { return (plane){~x.a, ~x.b, ~x.c}; }
static inline plane shl(plane x, int n) { return (plane){x.a << n, x.b << n, x.c << n}; }
static inline plane select(plane m, plane x, plane y) { return or(and(x, m), and(y, not(m))); }
static inline int any(plane x)
{
    v32w a = (v32w)(x.a | x.b);
    v16w c = (v16w)x.c;
    return (a[0] | a[1] | a[2] | a[3] | c[0] | c[1]) != 0;
}

/* 16 groups of 8 bytes: four rounds of interleaving vectors k and k + 4. */
static inline void deal(const uint8_t *frame, plane *planes)
{
    const v16 low = {0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23};
    const v16 high = {8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31};
    for (int y = 0; y < 8; y++)
        for (int k = 0; k < NPS / 16; k++) {
            v16 v[8], w[8];
            for (int pair = 0; pair < 8; pair++) {
                int lane = 16 * k + 2 * pair;
                memcpy(&v[pair],
                       frame + (lane / COLS_OF_NPS * 8 + y) * WIDTH + lane % COLS_OF_NPS * 8, 16);
            }
            for (int round = 0; round < 4; round++) {
                for (int i = 0; i < 4; i++) {
                    w[2 * i] = __builtin_shuffle(v[i], v[i + 4], low);
                    w[2 * i + 1] = __builtin_shuffle(v[i], v[i + 4], high);
                }
                memcpy(v, w, sizeof v);
            }
            for (int x = 0; x < 8; x++)
                memcpy((uint8_t *)&planes[8 * y + x] + 16 * k, &v[x], 16);
        }
}

static plane place(plane value, plane base)
{
    plane m = lower(value, all(0x10)), t = base;
    value = select(m, shl(value, 4), value);
    t = add(t, and(m, all(4)));
    m = lower(value, all(0x40));
    value = select(m, shl(value, 2), value);
    t = add(t, and(m, all(2)));
    m = lower(value, all(0x80));
    return add(t, and(m, all(1)));
}

static uint8_t maximum(plane value)
{
    uint8_t most = 0;
    for (int bit = 0; bit < 8; bit++) {
        plane top = lower(all(127), value);
        value = shl(value, 1);
        if (any(top)) {
            value = and(value, top);
            most |= 0x80 >> bit;
        }
    }
    return most;
}

static uint8_t middle(plane value, plane numbers)
{
    plane base = shl(numbers, 3), f = value, here = not(equal(value, all(0)));
    value = select(here, sub(all(0xFF), place(value, base)), value);
    uint8_t low = 0xFF - maximum(value);
    value = and(sub(all(0), f), f);
    value = select(here, place(value, base), value);
    return (uint8_t)((low + maximum(value)) >> 1);
}

static uint8_t predict(int center, int last, int edge)
{
    int next = 2 * center - last;
    return (uint8_t)(next < 0 ? 0 : next > edge ? edge : next);
}

typedef struct {
    plane signal[PIXELS], reset[PIXELS], previous[PIXELS], row, column;
    uint8_t last_row, last_col, known, started;
} chip;

/* frames: count x 64 x 80; results: count x 5. */
void trajectory(const uint8_t *frames, long count, int threshold, uint8_t *results)
{
    static chip c;
    memset(&c, 0, sizeof c);
    for (int i = 0; i < NPS; i++) {
        ((uint8_t *)&c.row)[i] = (uint8_t)(i / COLS_OF_NPS);
        ((uint8_t *)&c.column)[i] = (uint8_t)(i % COLS_OF_NPS);
    }
    for (long number = 0; number < count; number++) {
        uint8_t *out = results + 5 * number;
        memset(c.reset, 0, sizeof c.reset);
        deal(frames + number * 64 * 80, c.signal);
        plane columns = all(0xFF), rows = all(1);
        /* The sentinels fall out after eight passes, which is known beforehand. */
        for (int y = 0; y < 8; y++) {
            plane bits = all(1);
#pragma GCC unroll 8
            for (int pixel = 8 * y; pixel < 8 * y + 8; pixel++) {
                plane f = c.signal[pixel], t = c.reset[pixel];
                f = and(sub(f, t), not(lower(f, t)));
                t = c.previous[pixel];
                c.previous[pixel] = f;
                plane high = lower(f, t); /* as a number -1 or 0: the high byte */
                f = add(sub(f, t), all((uint8_t)(threshold - 1)));
                high = sub(high, lower(f, all((uint8_t)(threshold - 1))));
                plane borrow = lower(f, all((uint8_t)(2 * threshold - 1)));
                high = sub(high, all((uint8_t)((2 * threshold - 1) >> 8)));
                plane still = and(borrow, equal(high, all(0)));
                bits = sub(add(bits, bits), still);
            }
            columns = and(columns, bits);
            rows = sub(add(rows, rows), lower(bits, all(0xFF)));
        }
        columns = sub(all(0xFF), columns);
        if (!c.started || !any(rows)) {
            c.started = 1;
            memset(out, 0, 5);
            continue;
        }
        uint8_t row = middle(rows, c.row), col = middle(columns, c.column);
        if (!c.known) {
            c.last_row = row;
            c.last_col = col;
            c.known = 1;
        }
        out[0] = 1;
        out[1] = row;
        out[2] = col;
        out[3] = predict(row, c.last_row, 63);
        out[4] = predict(col, c.last_col, 79);
        c.last_row = row;
        c.last_col = col;
    }
}
