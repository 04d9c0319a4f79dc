"""`--why` names the fault that a campaign injected: reason, kind, message, identifier, and when it began."""
import unittest

import hostsim
import why_campaign


class Campaign(hostsim.Case):
    def check(self, count, *options):
        self.run_good("campaign", "--runs", count, "--seed", 19, "--why", "why.jsonl", *options, timeout=600)
        runs, problems = why_campaign.check(why_campaign.read([self.folder / "why.jsonl"]))
        self.assertEqual(sum(runs.values()), count)
        self.assertEqual(dict(problems), {})
        return runs

    def test_every_fault_of_a_campaign_is_named(self):
        self.assertGreater(len(self.check(700)), 45)

    def test_faults_at_an_engagement_are_named(self):
        self.check(200, "--newly-engaged")  # of 15 faults: each as often as above

    def test_the_check_can_fail(self):
        trip = {"reason": "EPS_STATUS_TIMEOUT", "t_ms": 2060, "kind": "silence", "message": "eps_status", "id": "167",
                "cause_ms": 2003}
        line = {"run": 0, "fault": "EPS_STATUS_TIMEOUT", "steps_ms": 2000, "cause_ms": 2000, "engage_ms": 0}

        def problem(**changes):
            return why_campaign.problem_of({**line, "trips": [{**trip, **changes}]})

        self.assertIsNone(problem())
        self.assertIn("not among the trips", problem(reason="EPS_HEARTBEAT_LOST"))
        self.assertIn("kind", problem(kind="stuck"))
        self.assertIn("message", problem(message="steering_status"))
        self.assertIn("id", problem(id=None))
        self.assertIn("cause at 2060", problem(cause_ms=2060))
        self.assertIn("cause at 1900", problem(cause_ms=1900))
        self.assertIn("cause at None", problem(cause_ms=None))

    def test_the_files_of_a_campaign_are_distinct(self):
        self.assert_refused(self.run_program("campaign", "--runs", 1, "--seed", 1, "--why", "a", "--results", "a"),
                            "are the same file")


if __name__ == "__main__":
    unittest.main()
