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
        self.assertEqual(set(self.check(700)), set(why_campaign.EXPECTED))

    def test_faults_at_an_engagement_are_named(self):
        self.check(200, "--newly-engaged")  # of 15 faults: each as often as above


if __name__ == "__main__":
    unittest.main()
