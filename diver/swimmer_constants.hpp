// Constants of the simulated swimmer (swimmer.cpp), each with its source or with what was measured.
//
// Measured: the program was built with one constant 0.7 and 1.4 times as large, and a man of 1.78 m
// with full gear swam 40 s straight on at 15 m, turned to a place behind and 3 m below, rose from
// 20 to 8 m, and hovered for 100 s in 0.1 m/s of current. With the constants as they are: 0.16 m
// off the depth at 82 W; turned in 71 s; rose by 7.7 m a minute at most and 0.17 m too high;
// hovered 0.17 m off the depth, tilted by 4.4 degrees, 3.9 m off the place. "Free" says that both
// factors stay within 0.18 m and 85 W; 69 to 73 s; 7.5 to 8.0 m a minute and 0.19 m; 0.24 m, 6
// degrees and 5.0 m: a choice that hardly changes the results. The gains in swimmer.cpp are free
// too, but for that of roll, and that of yaw: 0.7 times as large it misses the place behind by 1.6
// m in 75 s. The hover in these figures rested and swam back. Hands, knees, slow kicks and the way
// against a current, which hold the place now, were measured at rest at 15 and 5 m and in 0.05, 0.1
// and 0.2 m/s from the side for two minutes, three after the start: 0.03, 0.15, 0.36, 0.18 and 0.03
// m off the place at 2, 28, 6, 20 and 56 W; "free" there says that both factors stay within 0.8 m
// and 40 W (56 W in 0.2 m/s). Tests named here are those of tests/diver.
#pragma once

#include <cstdint>

#include "engine/core/math.hpp"

namespace neritic::diver::swimming {

// Way of a beat with full gear, m, from which the pace begins: measured, and held by
// Swimmer.ItsKickGivesWhatIsPublishedWithFinsAndBare.
inline constexpr double kMetresABeat = 0.52;

// No beat is slower; less speed has smaller ones: free.
inline constexpr double kSlowestBeat_hz = 0.25;

// Angles that steer, far inside the range of joints: hip 30 degrees back and to the inner side, 45
// to the outer; trunk 80 forward, 25 back, 35 to a side, 45 of twist (AAOS 1965, Joint Motion).
// Both legs up or down, and one up and one down: free.
inline constexpr double kMostLift_rad = radians(18.0), kMostTwist_rad = radians(14.0);
// One up and one down at 0.3 m/s and below, which rights a roll: free with a jacket. Without the
// jacket's cloth to lift it the tank on the back turns the diver over: a 15 l tank does at 14
// degrees, in 0.2 m/s.
inline constexpr double kMostSlowTwist_rad = radians(20.0);
// One leg beats by this share wider than the mean, the other narrower: free.
inline constexpr double kMostLeftMore = 0.5;
// Back and legs to a side. Less bend turns more slowly: at 0.7 times the diver misses the place
// behind by 0.9 m. Legs aside: free.
inline constexpr double kMostBend_rad = radians(18.0), kMostAside_rad = radians(25.0);
// Rolled to a side at most while turning by leaning: free.
inline constexpr double kMostBank_rad = radians(20.0);
// Up or down along the way: 0.15 m/s at 0.3 m/s. Free.
inline constexpr double kMostPitch_rad = radians(30.0);
// A joint goes to its new angle with this lag, in 1 s by 92 %; breath likewise: free.
inline constexpr double kSteeringLag_s = 0.4, kBreathLag_s = 0.7;
// Above this speed through the water legs steer, below it posture does: free.
inline constexpr double kWay_m_s = 0.25;
// A place farther round than this lies behind, and the diver keeps turning to one side: free.
inline constexpr double kBehind_rad = radians(140.0);

// Down by 9 m a minute at most, less than half of the 75 feet a minute that the US Navy Diving
// Manual allows; the body's own rate reaches 0.21 m/s.
inline constexpr double kMostSink_m_s = 0.15;
// Up by 7.2 m a minute: less than the 9 m (30 feet) that the NOAA Diving Manual teaches, since the
// body's rate swings around it. At 1.4 times it reaches 10.6 m a minute, at 0.7 times 5.4.
inline constexpr double kMostRise_m_s = 0.12;
// A place more than kWellOff_m above or below is approached at that rate, with the jacket held
// neutral, until kHardlyOff_m from it: free.
inline constexpr double kWellOff_m = 1.3, kHardlyOff_m = 0.2;
// The rate begins with this share (free) and grows with this lag, so that pitch and jacket follow:
// 0.7 times as long gives 8.3 m a minute, 1.4 times 7.1.
inline constexpr double kChangeBegin = 0.2, kChangeLag_s = 12.0;
// The pitch holds the rate this many times as firmly as a depth: free. Turns are limited on the
// way, since a sharp one brings the head up: at 0.7 times the diver misses the place behind by 3.2
// m in 75 s, at 1.4 times the turn takes 62 s.
inline constexpr double kChangeFirm = 2.0, kChangeTurn_rad = 0.2;

// A person who steers the depth (SwimGoal::climb_m_s) gets the rate and stops within seconds: by
// breath first, since pitch needs way. Litres for each m/s off the rate, with this lag, down to the
// residual volume and up by most of the inspiratory reserve of 2.3 l (LungSizes, body.hpp). Pitch
// holds the rate this many times as firmly as a depth; without way by this share. From a hover at
// 12 m the rate of 9 m a minute is reached in the third second; twice the breath or 2.7 times the
// firmness changes rates by less than 1 m a minute, no pitch without way halves that of the second
// second.
inline constexpr double kSteeredBreath_l_s = 20.0, kSteeredOut_m3 = 1.2e-3, kSteeredIn_m3 = 2.0e-3;
inline constexpr double kSteeredLag_s = 0.3, kSteeredFirm = 3.0, kSteeredRestPitch = 0.5;
// With the hips so near to the surface a body is partly out of the water: the depth of a trunk with
// a tank on it, and of heels that kick.
inline constexpr double kAwash_m = 0.6;

// Breath moves around its middle by half of the expiratory reserve, 1.2 l (LungSizes, body.hpp):
// free.
inline constexpr double kMostBreathBias_m3 = 0.6e-3;
// A hovering diver has no fins to hold the depth: breath answers this much more. Free.
inline constexpr double kHoverBreath = 1.5;

// Posture of a hovering diver, in each of two joints of the back, in shares of the legs' lift: it
// moves the jacket's gas, which otherwise runs to the higher end of the trunk. While swimming the
// share is 0.25. Free. The arms go forward by kHoverArms times the lift; their weight lowers the
// head. Free.
inline constexpr double kHoverBend = 1.0, kHoverArms = 4.0;
// Knees bend by this multiple of the legs' lift, slowly, where the head sinks: a suit lifts shins,
// which then lie nearer to the middle. With straight knees treading fins push a diver with a full
// tank at 5 m on by 0.07 m/s. Slow kicks with straight knees roll by 15 degrees. Free.
inline constexpr double kHoverKnees = 5.0, kKneesLag_s = 3.0;
// Where posture is hardly enough, the shins beat in turn: moving fins hold on to the water. All
// free. kTreads: the share of steering up to which posture alone holds the pitch.
inline constexpr double kTread_rad = radians(5.0), kTread_hz = 1.0, kTreads = 0.3;
// Hands that scull: forearms hang down and swing about the elbows by kScull_rad at most, once in
// kScull_s: a stroke takes kStroke of it, the slower way back the rest. Whole strokes move a diver
// at 0.06 m/s for 45 W. Free.
inline constexpr double kScull_rad = radians(35.0), kScull_s = 1.6, kStroke = 0.25,
                        kScullsLag_s = 1.0;
// Shares of a whole stroke for each metre off the place, each m/s, each radian off the heading and
// each rad/s: the place is held like by a spring with a period of 50 s, damped. Free.
inline constexpr double kScullMetre = 0.8, kScullSpeed_s = 10.0, kScullTurn = 0.8,
                        kScullTurning_s = 5.0;
// A place farther to a side is turned to, ahead or behind, since hands push along the body: free.
inline constexpr double kAside_m = 0.3;
// A hovering diver swims back from this distance, or to right himself from this tilt, and rests
// again at kNear_m: free.
inline constexpr double kAdrift_m = 3.0, kNear_m = 0.7, kTilted_rad = radians(20.0);
// Steeper than this a kick would carry the diver up or down. The diver then stoops by kStoop_rad in
// each of two joints of the back, legs behind. Either 0.7 times as large gives 8.5 degrees off
// level while hovering.
inline constexpr double kSteep_rad = radians(25.0), kStoop_rad = radians(17.0);
// More upright than this, a diver who is to swim level lies down first, as one who hovers does.
inline constexpr double kUpright_rad = radians(55.0);
inline constexpr double kStoopLag_s = 0.7;  // free
// A faster drift is a current: the head stays into it, kAsideMetre over the drift to a side for
// each metre that the place lies there, less kAsideSpeed_s for each m/s towards it, at most
// kMostCrab_rad; a drift below kLeastDrift_m_s counts as that. Free.
inline constexpr double kStill_m_s = 0.03, kAsideMetre = 0.05, kAsideSpeed_s = 0.5;
inline constexpr double kLeastDrift_m_s = 0.1, kMostCrab_rad = 0.5;
// Against it the diver swims as fast as it is, and faster for each metre downstream, by kMostGain
// at most. In one slower than kSlowCurrent_m_s legs hardly steer: hands turn a diver who is off the
// heading by more than kOffHeading_rad, breath alone holds the depth while the legs hardly move,
// and no kick carries on one who looks elsewhere. Free.
inline constexpr double kGainMetre_1_s = 0.08, kMostGain_m_s = 0.25, kMostAgainst_m_s = 0.8;
inline constexpr double kSlowCurrent_m_s = 0.15, kOffHeading_rad = 0.5;
inline constexpr double kLevelWay_m_s = 0.04;
// Speed of the way back in still water, which a vehicle beside can follow
// (Swimmer.ComesBackNoFasterThanWhoKeepsBesideCanFollow). A body that rights itself needs way, in a
// current more by the drift and for each metre off. Free.
inline constexpr double kBack_m_s = 0.15;
struct Righting {
  double speed_m_s, each_metre_1_s, most_m_s;
};
inline constexpr Righting kRighting{0.35, 0.15, 0.8};
inline constexpr std::uint64_t kGoesBack = 1, kRightsHimself = 2, kKicksUp = 3;
// Sunk so far below the place, a diver whom no jacket lifts swims up to it at this speed: free.
inline constexpr double kSunk_m = 1.5, kKickUp_m_s = 0.5;

// A button is pressed for kPress_s after kSure_l_s of unmet want of breath, then left for kWait_s:
// the inflator gives 0.17 l in that time at 15 m (100 l a minute of 1 bar, gear.hpp). Free.
inline constexpr double kPress_s = 0.25, kWait_s = 3.0, kSure_l_s = 4.0;
// So much excess or missing lift is most of what breath can hold (kMostBreathBias_m3): a button is
// pressed at once. Free.
inline constexpr double kBreathHolds_l = 0.5;
// A rising diver lets gas out at an excess lift of kUsualAt_l until usual_to_l, and in at a lack of
// unusual_at_l until unusual_to_l; a sinking diver the other way round. At most kChangeSum_l_s of
// unmet want of breath is remembered. Free.
inline constexpr double kUsualAt_l = 0.2, kUsualWait_s = 2.0;
struct LiftBand {
  double usual_to_l = 0.0, unusual_at_l = -0.8, unusual_to_l = -0.5, wait_s = kWait_s;
};
// Where a person steers the depth the jacket is held as closely on either side.
inline constexpr LiftBand kSteeredBand{0.1, -kUsualAt_l, -0.1, kUsualWait_s};
inline constexpr double kChangeSum_l_s = 2.0;
// A jacket with less gas is empty: 24 ml at the surface, a seventh of a press at 15 m. A tank below
// this pressure fills none: it exceeds the ambient pressure down to 40 m by 0 to 4 bar.
inline constexpr double kEmptyJacket_mol = 1e-3, kFillsJacket_pa = 5e5;
// Gas leaves at the higher end of the trunk: the head goes up by kVentPitch_rad for at most
// kVent_s. The dump valve passes 0.4 l in kVentPress_s at 10 m (5 l a second, gear.hpp). Free.
inline constexpr double kVent_s = 6.0, kVentPress_s = 0.08, kVentPitch_rad = radians(14.0);

}  // namespace neritic::diver::swimming
