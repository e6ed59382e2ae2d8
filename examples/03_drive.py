"""Drive a mission with Algorithm 2 in SUMO's traffic, and look at what happened: events one by one, then the sum."""

from tmpud import Estimated, Event, Mission, drive, summarise

mission = Mission(map="millbrook", start="park2e_0", goal="high3n_1", traffic=120, seed=1)

events: list[Event] = []
for event in drive(mission, frames=False):
    events.append(event)
    if isinstance(event, Estimated):
        print(f"{event.time:6.1f} s  {event.step.action:<10} Safe = {event.safe:.2f}")

summary = summarise(events)
print(f"{summary['status']}: {summary['distance_m']:.0f} m in {summary['travel_time_s']:.0f} s")
print(f"{summary['collisions']} collisions, {summary['forced_stops']} forced stops, {summary['replans']} replans")
