/* The plain crank-slider as an expert writes it for this mechanism alone: massless crank, level guide through O, gravity,
   the coupler's centre on A-B. The library's formulas with nothing absent, doubled or guarded; what the crank angles
   share is taken out of the loop. With s and c of the coupler, k its rate and e its angular acceleration by crank angle,
   the point at the distance a from A on the coupler has the acceleration -(x + a p, y - a q) by crank angle.

   Balanced, with a circular cam and a spring along the guide, A runs on the circle of radius `radius` about (offset, 0),
   at r on the ray of the crank; lean is r'/r, and the cam's normal leans by radius / root from the ray.

   With RECIPROCAL the divisions, too, are taken out or together, which rounds once more for each. */

#define _GNU_SOURCE
#include <math.h>

#ifdef RECIPROCAL
#define OVER_LENGTH(value) ((value) * d.shorter)
#define OVER_COSINE(value) ((value) * inverse)
#define OVER_ALONG(value) ((value) * (d.shorter * inverse))
#else
#define OVER_LENGTH(value) ((value) / d.length)
#define OVER_COSINE(value) ((value) / c)
#define OVER_ALONG(value) ((value) / along)
#endif

typedef struct {
    double speed, crank, length, centre, coupler, inertia, slider, gravity;
} Design;

typedef struct {
    double crank, length, shorter, centre, coupler, inertia, slider, coupler_weight, slider_weight;
} Shared;

static inline Shared shared(const Design *d)
{
    double square = d->speed * d->speed;
    return (Shared){d->crank, d->length, 1.0 / d->length, d->centre, d->coupler * square, d->inertia * square,
                    d->slider * square, d->coupler * d->gravity, d->slider * d->gravity};
}

/* Into rows of n values: O, A, B (x and y each), guide force, guide moment, torque. */
static inline void forces(Shared d, double sine, double cosine, double *row, long n)
{
    double x = d.crank * cosine, y = d.crank * sine;
    double s = OVER_LENGTH(-y), along = sqrt((d.length - y) * (d.length + y)), c = OVER_LENGTH(along);
    double inverse = 1.0 / c, k = OVER_ALONG(x), k2 = k * k, e = OVER_ALONG(y - k2 * y);
    double p = e * s + k2 * c, q = e * c - k2 * s;
    double load_x = d.coupler * (x + d.centre * p);
    double load_y = d.coupler * (y - d.centre * q) - d.coupler_weight;
    double moment = d.centre * (c * load_y - s * load_x) - d.inertia * e;
    double pin_x = -d.slider * (x + d.length * p);
    double pin_y = OVER_COSINE(OVER_LENGTH(moment) + s * pin_x);
    double inner_x = pin_x - load_x, inner_y = pin_y - load_y;
    row[0] = row[2 * n] = inner_x;
    row[n] = row[3 * n] = inner_y;
    row[4 * n] = pin_x;
    row[5 * n] = pin_y;
    row[6 * n] = d.slider_weight - pin_y;
    row[7 * n] = 0.0;
    row[8 * n] = x * inner_y - y * inner_x;
}

typedef struct {
    double radius, offset, stiffness, free;
} Balance;

/* Into rows of n values: the same, and the forces of the cam and of the slotted crank. */
static inline void balanced(Shared d, Balance b, double sine, double cosine, double *row, long n)
{
    double u = b.offset * cosine, w = b.offset * sine, root = sqrt((b.radius - w) * (b.radius + w));
    double over = 1.0 / root, r = u + root, lean = -w * over, slope = lean * r, secant = b.radius * over;
    double bend = lean * slope - u * (secant * secant) * r * over, x = r * cosine, y = r * sine;
    double y1 = slope * sine + x;
    double x2 = bend * cosine - 2.0 * slope * sine - x, y2 = bend * sine + 2.0 * slope * cosine - y;
    double along = sqrt((d.length - y) * (d.length + y)), inverse = 1.0 / along;
    double s = -y * d.shorter, c = along * d.shorter, k = y1 * inverse, k2 = k * k, e = -(y2 + k2 * y) * inverse;
    double p = e * s + k2 * c, q = e * c - k2 * s;
    double load_x = d.coupler * (d.centre * p - x2);
    double load_y = -d.coupler * (y2 + d.centre * q) - d.coupler_weight;
    double moment = d.centre * (c * load_y - s * load_x) - d.inertia * e;
    double pin_x = -d.slider * (d.length * p - x2) + b.stiffness * (x + along - b.free);
    double pin_y = (moment + s * d.length * pin_x) * inverse;
    double inner_x = pin_x - load_x, inner_y = pin_y - load_y;
    double outward = -(inner_x * cosine + inner_y * sine);
    double slot = outward * lean + inner_x * sine - inner_y * cosine;
    row[0] = slot * sine;
    row[n] = -slot * cosine;
    row[2 * n] = inner_x;
    row[3 * n] = inner_y;
    row[4 * n] = pin_x;
    row[5 * n] = pin_y;
    row[6 * n] = d.slider_weight - pin_y;
    row[7 * n] = 0.0;
    row[8 * n] = -slot * r;
    row[9 * n] = outward * secant;
    row[10 * n] = -slot;
}

void turn(const Design *design, long n, const double *angle, double *rows)
{
    Shared d = shared(design);
    for (long i = 0; i < n; i++) {
        double sine, cosine;
        sincos(angle[i], &sine, &cosine);
        forces(d, sine, cosine, rows + i, n);
    }
}

void sweep(const Design *designs, long count, long n, const double *sine, const double *cosine, double *rows)
{
    for (long design = 0; design < count; design++) {
        Shared d = shared(designs + design);
#pragma GCC ivdep
        for (long i = 0; i < n; i++)
            forces(d, sine[i], cosine[i], rows + 9 * n * design + i, n);
    }
}

void sweep_balanced(const Design *designs, const Balance *balances, long count, long n, const double *sine,
                    const double *cosine, double *rows)
{
    for (long design = 0; design < count; design++) {
        Shared d = shared(designs + design);
        Balance b = balances[design];
#pragma GCC ivdep
        for (long i = 0; i < n; i++)
            balanced(d, b, sine[i], cosine[i], rows + 11 * n * design + i, n);
    }
}
